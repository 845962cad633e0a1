// The part of the image that a pass of several needs: the view without its guard band, and `reach` pixels more on each
// side for the passes that read it. While a restriction lives, nothing outside is drawn.
#pragma once

#include <string_view>

#include <glm/glm.hpp>

#include "rasterizer/pass.h"

namespace plumb {

class InnerArea {
public:
    // Where somebody reads the plane `read_beyond`, whose pass reads the guard band as well, the area is the whole
    // image.
    InnerArea(const PassResources& resources, glm::ivec2 reach, std::string_view read_beyond = {});

    // Width and height of what lies outside on each side, in pixels.
    glm::ivec2 corner() const { return corner_; }

    class Restriction {
    public:
        explicit Restriction(const InnerArea& area);
        ~Restriction();
        Restriction(const Restriction&) = delete;
        Restriction& operator=(const Restriction&) = delete;

    private:
        const InnerArea& area_;
    };

private:
    GlContext& context_;
    glm::ivec2 corner_, size_;
};

}  // namespace plumb
