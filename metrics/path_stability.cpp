#include "metrics/path_stability.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "frames/image_error.h"
#include "frames/parallel.h"
#include "metrics/shape.h"

namespace plumb {
namespace {

// A surface point followed back through frames.
class Track {
public:
    Track(const FrameErrors& now, int x, int y, double tolerance) : x_(x), y_(y) {
        const auto position = now.position.pixel(x, y);
        position_ = {position[0], position[1], position[2]};
        const double depth = now.depth.at(x, y);
        visible_ = is_surface(depth);
        if (visible_) radius_ = same_surface_radius(now.position, depth, x, y, tolerance);
        motion_ = {now.motion.at(x, y, 0), now.motion.at(x, y, 1)};
    }

    // To the frame before the one it is at; false where the point is not visible there.
    bool step_back(const FrameErrors& before) {
        x_ += motion_[0], y_ += motion_[1];
        // Also false for motion that is no number, before floor() meets it.
        visible_ = visible_ && x_ > -1.0 && x_ < before.position.width() && y_ > -1.0 && y_ < before.position.height();
        if (!visible_) return false;
        place_ = BilinearPlace::at(x_, y_);
        visible_ = shows_surface(place_, before.position, position_, radius_);
        if (visible_) motion_ = {place_.look_up(before.motion, 0), place_.look_up(before.motion, 1)};
        return visible_;
    }

    const BilinearPlace& place() const { return place_; }

private:
    double x_, y_, radius_ = 0;
    std::array<double, 3> position_{};
    std::array<double, 2> motion_{};
    BilinearPlace place_{};
    bool visible_ = false;
};

// Covariance of the errors against both halves over the frames of a window: the variance of the error.
class Covariance {
public:
    void add(double a, double b) {
        // Welford's update, which does not lose a small variance below a large mean.
        ++count_;
        const double from_old_mean = a - mean_a_;
        mean_a_ += from_old_mean / count_;
        mean_b_ += (b - mean_b_) / count_;
        sum_ += from_old_mean * (b - mean_b_);
    }
    double value() const { return sum_ / (count_ - 1); }

private:
    int count_ = 0;
    double mean_a_ = 0, mean_b_ = 0, sum_ = 0;
};

}  // namespace

std::vector<std::pair<std::string, double>> PathStabilityResult::measures() const {
    std::vector<std::pair<std::string, double>> list;
    for (const auto& [name, estimate] : {std::pair<std::string, Estimate>{"flicker", flicker},
                                         {"method_warping", method_warping},
                                         {"truth_warping", truth_warping},
                                         {"temporal_variance", temporal_variance}}) {
        list.emplace_back(name, estimate.value);
        list.emplace_back(name + "_lower", estimate.lower);
        list.emplace_back(name + "_upper", estimate.upper);
    }
    list.emplace_back("flicker_noise", noise);
    list.emplace_back("flicker_trustworthy", trustworthy ? 1.0 : 0.0);
    return list;
}

double PathStabilityResult::measure(std::string_view name) const {
    for (const auto& [known, value] : measures()) {
        if (known == name) return value;
    }
    return std::numeric_limits<double>::quiet_NaN();
}

bool PathStabilityResult::tells(std::string_view name) const {
    if (name.starts_with("temporal_variance")) return noise == 0.0 || temporal_variance.lower > 0.0;
    return !name.starts_with("flicker") || trustworthy;
}

std::optional<std::int64_t> PathStabilityResult::samples_needed(int reference_samples) const {
    const double most = flicker.value > 0.0 ? flicker.value : flicker.upper;
    if (reference_samples <= 0 || !(most > 0.0) || !std::isfinite(most)) return std::nullopt;
    const double samples = reference_samples * noise * noise / (noise_limit * most * most);
    return 2 * static_cast<std::int64_t>(std::ceil(std::max(samples, 2.0) / 2.0));
}

const std::vector<std::string>& stability_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const auto& [name, value] : PathStabilityResult{}.measures()) list.push_back(name);
        return list;
    }();
    return names;
}

PathStability::PathStability(std::string plane, const PathStabilitySettings& settings)
    : plane_(std::move(plane)), settings_(settings) {
    if (settings.window < 2 || !(settings.noise_limit > 0.0)) {
        throw ImageError(
            fmt::format("temporal variance needs a window of at least 2 frames and a noise limit above "
                        "zero, not {} and {}",
                        settings.window, settings.noise_limit));
    }
}

std::optional<Flicker> PathStability::add(const Frame& method, const Frame& truth, const Image* mask,
                                          const std::vector<Region>& regions) {
    require_motion(truth, "the truth");
    past_.push_back(FrameErrors::of(method, truth, plane_));
    ++frames_;
    const FrameErrors& now = past_.back();
    if (mask) require_mask_fits(*mask, now.method);
    for (const Region& region : regions) require_mask_fits(region.mask, now.method);
    if (past_.size() < 2) return std::nullopt;
    const BlockGrid grid(now.method.width(), now.method.height(), settings_.flicker.bootstrap.block_size);
    const auto change_within = [&](const Image* within) {
        return sum_changes(past_[past_.size() - 2], now, grid, settings_.flicker.tolerance, within);
    };
    ChangeSums change = change_within(mask);
    const Flicker of_frame = flicker_of(change, settings_.flicker.bootstrap);
    add_change(std::move(change), grid, mask, whole_);
    for (const Region& region : regions)
        add_change(change_within(&region.mask), grid, &region.mask, regions_[region.name]);
    if (past_.size() == static_cast<std::size_t>(settings_.window)) past_.pop_front();
    return of_frame;
}

// Also the variance, where enough frames have passed.
void PathStability::add_change(ChangeSums change, const BlockGrid& grid, const Image* mask, Sums& sums) const {
    sums.error.add(std::move(change.error));
    sums.method.add(std::move(change.method));
    sums.truth.add(std::move(change.truth));
    sums.noise.add(std::move(change.noise));
    sums.pixels += change.pixels, sums.not_visible += change.not_visible, sums.non_finite += change.non_finite;
    if (past_.size() == static_cast<std::size_t>(settings_.window)) sums.variance.add(sum_variances(grid, mask));
}

std::vector<BlockSum> PathStability::sum_variances(const BlockGrid& grid, const Image* mask) const {
    const FrameErrors& now = past_.back();
    const int width = now.method.width(), height = now.method.height(), channels = now.method.channels();
    std::vector<BlockSum> blocks(grid.count());
    parallel_for(grid.rows(), [&](int row) {
        std::vector<Covariance> of_channels;
        const int end = std::min(height, (row + 1) * grid.block_size());
        for (int y = row * grid.block_size(); y < end; ++y) {
            for (int x = 0; x < width; ++x) {
                if (!pixel_counts(mask, x, y)) continue;
                of_channels.assign(static_cast<std::size_t>(channels), {});
                for (int c = 0; c < channels; ++c) {
                    of_channels[static_cast<std::size_t>(c)].add(now.error_a.at(x, y, c), now.error_b.at(x, y, c));
                }
                Track track(now, x, y, settings_.flicker.tolerance);
                const bool throughout = std::all_of(past_.rbegin() + 1, past_.rend(), [&](const FrameErrors& before) {
                    if (!track.step_back(before)) return false;
                    for (int c = 0; c < channels; ++c) {
                        of_channels[static_cast<std::size_t>(c)].add(track.place().look_up(before.error_a, c),
                                                                     track.place().look_up(before.error_b, c));
                    }
                    return true;
                });
                if (!throughout) continue;
                double sum = 0.0;
                for (const Covariance& covariance : of_channels) sum += covariance.value();
                if (std::isfinite(sum)) blocks[grid.block_of(x, y)].add(sum, static_cast<std::size_t>(channels));
            }
        }
    });
    return blocks;
}

std::map<std::string, PathStabilityResult> PathStability::of_regions() const {
    std::map<std::string, PathStabilityResult> results;
    for (const auto& [name, sums] : regions_) results.emplace(name, result_of(sums));
    return results;
}

PathStabilityResult PathStability::result_of(const Sums& sums) const {
    const BootstrapSettings& bootstrap = settings_.flicker.bootstrap;
    PathStabilityResult result;
    result.frames = frames_;
    const Estimate squared = sums.error.mean(bootstrap);
    result.flicker = squared.root();
    result.method_warping = sums.method.mean(bootstrap).root();
    result.truth_warping = sums.truth.mean(bootstrap).root();
    result.temporal_variance = sums.variance.mean(bootstrap);
    const double noise = sums.noise.mean(bootstrap).value;
    result.noise = std::sqrt(noise), result.noise_limit = settings_.noise_limit;
    result.trustworthy = noise == 0.0 || (noise <= settings_.noise_limit * squared.value && squared.lower > 0.0);
    result.pixels = sums.pixels, result.not_visible = sums.not_visible, result.non_finite = sums.non_finite;
    return result;
}

}  // namespace plumb
