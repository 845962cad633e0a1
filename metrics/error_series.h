// The error over a series of images: the frames of a path, or one view rendered with many seeds.
//
// The mean over all images of mean (I - A)(I - B), free of the truth's noise as referenced_error.h has it. Its 95 %
// interval draws blocks of the image and members of the series at once (block_bootstrap.h): it covers how unevenly the
// error is spread over the image and how much it changes from frame to frame or from seed to seed. Beside it stands the
// interval over members alone, Student's t of their errors: what to quote where this very view is meant, not views like
// it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "frames/frame.h"
#include "metrics/referenced_error.h"
#include "metrics/student.h"

namespace plumb {

enum class SeriesOf {
    frames,  // consecutive: neighbours are alike, and are drawn in runs
    seeds,   // independent of each other
};
// As BlockSeries takes it.
constexpr std::size_t longest_run(SeriesOf kind) { return kind == SeriesOf::frames ? 8 : 1; }

class ErrorSeries {
public:
    explicit ErrorSeries(SeriesOf kind, const ReferencedErrorSettings& settings = {});

    // The next image, and the truth it belongs to; gives its own error. settings.mask is replaced by `mask`. Members
    // without any value that counts are not in the mean; nothing is given for them. Throws ImageError where shapes
    // differ within the series.
    std::optional<ReferencedError> add(const Frame& method, const Frame& reference, std::string_view plane,
                                       int reference_samples, const Image* mask = nullptr);

    // The same of sums over a grid without a mask, which all members share.
    void add(ErrorSums sums, int reference_samples);

    std::size_t members() const { return errors_.size(); }
    // Over all members. Throws ImageError where there is none.
    ReferencedError error() const;
    // Of the members' errors alone.
    Estimate over_members() const { return student_mean(errors_); }

private:
    ReferencedErrorSettings settings_;
    BlockSeries products_;
    std::array<BlockSeries, relative_mses.size()> relative_;
    ErrorSums sums_;              // its blocks stay empty
    std::vector<double> errors_;  // mse of each member
    int least_samples_ = 0;       // per pixel, of all references
};

}  // namespace plumb
