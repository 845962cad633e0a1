// How many frames a method lags behind a change that it shows.
//
// A path whose camera stands still begins settled, something changes (a lamp moves), and after its last frame all is
// held until the method shows what it will show. With the share of the change that is made in frame t,
//
//   u_t = <T_t - T_0, D> / <D, D> of the truth T,   v_t = <M_t - M_0, D> / <M_settled - M_0, D> of the method M,
//   D = T_last - T_0,   <.,.> the sum over pixels and channels,
//
//   lag = sum over all frames, the held ones included, of u_t - v_t
//
// which is the area between the two curves. Of any linear filter in time it is the mean delay of the filter's weights
// (the first moment of its impulse response), whatever the course of the change: `d` for a picture that comes d frames
// late, and alpha / (1 - alpha) for M_t = (1 - alpha) X_t + alpha M_{t-1}, which is also how many frames that filter
// stays behind a ramp. A method that errs by a constant or by a factor lags no more for it, since its own beginning and
// end are what it is measured by; noise that is removed does not pass for lag removed, as it does in flicker.
//
// Only pixels that show the same point of the same surface through all frames count, and they count by how much the
// truth changes there. With a truth in halves A and B products are taken across them, so that its noise biases nothing.
//   Good for: history that carries light on. Bad for: changes that come back to where they began (D is noise then, and
//   there is no lag to tell), and paths held too shortly: a filter of which the share r is still to come is told a lag
//   that is too small by about r times the frames.
//
// 95 % interval: bootstrap over blocks of the image (block_bootstrap.h). Memory: a few images, however long the path.
#pragma once

#include <string>

#include "frames/frame.h"
#include "metrics/block_bootstrap.h"
#include "metrics/surface_motion.h"

namespace plumb {

struct PathLagSettings {
    double tolerance = same_surface_tolerance;
    BootstrapSettings bootstrap;
};

class PathLag {
public:
    explicit PathLag(std::string plane, const PathLagSettings& settings = {});

    // The next frame of the path. The truth needs motion, depth and position beside the plane. Throws ImageError for
    // missing planes and sizes that change.
    void add(const Frame& method, const Frame& truth);
    // What the method showed in `frames` frames after the last, nothing moving: the sum of these pictures, and the mean
    // of those at their end, when it had settled (several, where its noise differs from frame to frame). Throws
    // ImageError where shapes differ or no frame was added.
    void hold(const Image& sum, const Image& settled, int frames);

    // In frames. NaN where nothing was held, no pixel stood still, or the truth did not change by more than its noise.
    Estimate result() const;

private:
    // First and latest frame, and the sum of all but the first.
    struct Course {
        Image first, last, sum;
        void add(const Image& image);
    };

    std::string plane_;
    PathLagSettings settings_;
    Course method_, truth_a_, truth_b_;
    Image first_position_;
    Image still_;     // 1 where a pixel has shown the same point in every frame
    int frames_ = 0;  // of the path
    int held_frames_ = 0;
    Image held_sum_, settled_;
};

}  // namespace plumb
