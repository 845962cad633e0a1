// The points that samples are made of, as settings name them.
#pragma once

namespace plumb {

// Which points samples are made of.
enum class SamplePoints {
    sobol,   // Owen-scrambled Sobol points
    random,  // independent points, to compare with
};

}  // namespace plumb
