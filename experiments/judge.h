// Frames that another renderer made, judged by the path tracer's truth of the same cameras.
//
// Every truth comes from the reference cache or is rendered, with the exact G-buffer beside it, so that regions and
// flicker are measured too. Whether the truth is good enough to tell, its noise decides (metrics/referenced_error.h).
#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "experiments/camera_frames.h"
#include "experiments/progress_line.h"
#include "experiments/reference_cache.h"
#include "experiments/sequence_comparison.h"
#include "pathtracer/reference.h"

namespace plumb {

struct JudgeSettings {
    std::string scene;  // as messages and the cache's records call it
    CameraSequence cameras;
    std::vector<std::string> planes;               // of light or of the G-buffer
    std::map<std::string, std::string> renamings;  // foreign_frame.h
    ReferenceSettings reference;                   // its planes are replaced
    SequenceSettings comparison;
    int threads = 0;  // of the path tracer; 0: all
    const std::atomic<bool>* stop = nullptr;
};

class Judge {
public:
    // Keeps references to the scene, the cache and the progress. One file per frame of settings.cameras.
    Judge(const Scene& scene, std::vector<std::filesystem::path> files, JudgeSettings settings,
          const ReferenceCache& cache, ProgressLine& progress);
    ~Judge();

    // False where it was stopped; truths that were finished are kept in the cache. Throws ImageError for files of
    // another size or without a plane that is judged, and what rendering throws.
    bool run();

    const SequenceComparison& comparison() const { return comparison_; }
    // One line per plane whose error is lost in the truth's noise: how many samples would do.
    std::vector<std::string> noise_warnings() const;
    // One map per frame and plane, scaled by error_map_scales(). Returns their legend. Reads frames and truths again.
    std::string write_error_maps(const std::filesystem::path& folder, double scale);

private:
    Frame read(int frame) const;
    // Empty where it was stopped.
    Frame truth(int frame);

    const Scene& scene_;
    std::vector<std::filesystem::path> files_;
    JudgeSettings settings_;
    const ReferenceCache& cache_;
    ProgressLine& progress_;
    bool scene_moves_;
    std::unique_ptr<PathTracer> tracer_;
    SequenceComparison comparison_;
};

}  // namespace plumb
