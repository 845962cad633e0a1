// For tests that ask pictures of a small busy scene whether a parameter matters.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "frames/frame.h"
#include "rasterizer/gl_context.h"
#include "rasterizer/method.h"
#include "scenes/scene.h"

namespace plumb {

// What no picture can tell, with the reason.
const std::map<std::string, std::string>& parameters_without_pixels();

// The method in which `name` matters, small enough to be rendered many times.
Method small_method(const std::string& name);
// Planes in which it shows.
std::vector<std::string> telling_planes(const std::string& name);
// Another value of `name`, which shows at this size within few frames.
void use_another_value(Method& method, const std::string& name);

struct PictureSize {
    int width = 48, height = 36;
};
// What a few pixels do not show, this may; and G3D's normals want more lines than the small one has.
constexpr PictureSize larger_picture = {240, 180};

// Of the last of three frames of make_busy_scene().
Frame render_busy_frames(GlContext& context, const Scene& scene, const Method& method,
                         const std::vector<std::string>& planes, const PictureSize& size = {});
bool same_pixels(const Frame& first, const Frame& second, const std::vector<std::string>& planes);

}  // namespace plumb
