// Pairs of a parameter and what may take its effect away - a value of another parameter, or the planes that are asked
// for - and whether pictures bear out what is said of them: a parameter that changes no pixel is refused, and one that
// is refused changes none.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "rasterizer/gl_context.h"
#include "rasterizer/method.h"
#include "scenes/scene.h"

namespace plumb {

struct ParameterPair {
    std::string name;                 // the parameter that is asked about
    std::string beside;               // "ao.intensity = 0", or the plane
    Method method;                    // in which it is
    std::vector<std::string> planes;  // that are asked for
};

// Each parameter beside the values of the others of its group ("ao", "radiosity"...) that may leave it nothing to do:
// every choice, and ends of ranges.
std::vector<ParameterPair> pairs_within(const std::string& group);
std::vector<std::string> parameter_groups();
// Each parameter beside each plane by itself.
std::vector<ParameterPair> pairs_with_planes();

struct PairVerdicts {
    std::vector<std::string> silent;   // changes no pixel, and nobody says so
    std::vector<std::string> slander;  // changes a pixel, and is said not to
    std::size_t compared = 0;
};

// Of every `stride`-th pair from `first` on. Those that a pipeline refuses have been told, and are left out, as are the
// named exceptions.
PairVerdicts judge_pairs(GlContext& context, const Scene& scene, const std::vector<ParameterPair>& pairs,
                         std::size_t first = 0, std::size_t stride = 1);

}  // namespace plumb
