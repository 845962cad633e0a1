// Emissive surfaces that move: takes their pieces, and the cubes that their shadows are tested in, along frame by
// frame.
//
// An emitter is found once, where the scene has it (emitter_light.h), and carried from there by its instance's motion.
// That is exact for triangles and sample points under any motion, and for the discs of a fine mesh under turns and even
// scaling; under uneven scaling a disc takes on the area that its mean facet has.
#pragma once

#include <optional>
#include <vector>

#include "rasterizer/light_set.h"

namespace plumb {

class MovingEmitters {
public:
    // Of the emitters in the LightSet of the same scene and settings.
    MovingEmitters(const Scene& scene, const DirectSettings& direct);

    // Puts what moves in `lights`, which is that LightSet, where it is at `time` (Moment::time). False: everything was
    // there already.
    bool move_to(const std::optional<double>& time, LightSet& lights);

private:
    struct Emitter {
        const Instance* instance;
        EmitterLight found;
        std::size_t first_piece, first_cube;
        glm::mat4 pose;  // for which `lights` was set last
    };

    Bounds bounds_;
    bool linear_cubes_;
    std::vector<Emitter> emitters_;
};

}  // namespace plumb
