// The pictures of a camera path: truth, methods and error maps frame by frame, as JPEG files that a page plays.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/results.h"
#include "frames/image.h"

namespace plumb {

// What a method made of one plane along a camera path.
struct PathImages {
    std::string label;
    std::vector<const Image*> frames;   // none of them null; they live until the pictures are written
    std::vector<double> rmse, flicker;  // per frame; NaN where there is none
};

// Writes `folder`/pictures/SCENE.PATH.PLANE.*.NNNN.jpg, and returns `subject` (scene, path, plane, truth and
// frames_per_second filled in) with its strips: the truth, then each method followed by its error map. All frames share
// one exposure (the truth's 99th percentile is nearly white) and one error scale (the 99th percentile of the worst
// frame's error). Pictures wider than 480 pixels are made smaller: they are to be looked at, not measured. Throws
// ImageError where a method has another number of frames or another size than the truth, or a file cannot be written.
PathPictures write_path_pictures(PathPictures subject, const std::vector<const Image*>& truth,
                                 const std::vector<PathImages>& methods, const std::filesystem::path& folder);

}  // namespace plumb
