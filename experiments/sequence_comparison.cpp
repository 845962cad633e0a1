#include "experiments/sequence_comparison.h"

#include <algorithm>
#include <cmath>

#include "experiments/no_value.h"
#include "metrics/gbuffer_fidelity.h"
#include "metrics/shape.h"

namespace plumb {
namespace {

bool knows_motion(const Frame& reference) {
    return reference.has("motion") && reference.has("position") && reference.has("depth");
}

bool has_halves(const Frame& reference, const std::string& plane) {
    return reference.has("half_a." + plane) && reference.has("half_b." + plane);
}

// Whether any value within the mask is finite on both sides.
bool has_values(const Image& test, const Image& reference, const Image& mask) {
    for (int y = 0; y < test.height(); ++y) {
        for (int x = 0; x < test.width(); ++x) {
            if (!pixel_counts(&mask, x, y)) continue;
            for (int c = 0; c < test.channels(); ++c) {
                if (std::isfinite(test.at(x, y, c)) && std::isfinite(reference.at(x, y, c))) return true;
            }
        }
    }
    return false;
}

double mean(const std::vector<double>& values) {
    double sum = 0.0, count = 0.0;
    for (const double value : values) {
        if (!std::isnan(value)) sum += value, count += 1.0;
    }
    return count > 0.0 ? sum / count : no_value;
}

double mean_square(std::vector<double> values) {
    for (double& value : values) value *= value;
    return mean(values);
}

// One measure over all frames; those that need more than their own values come after.
double over_frames(const std::string& measure, const std::vector<double>& values) {
    if (measure == "rmse") return std::sqrt(mean_square(values));
    if (measure.ends_with("maximum")) return std::ranges::max(values);
    if (measure.ends_with("_lower") || measure.ends_with("_upper")) return no_value;  // no mean of intervals is one
    const double average = mean(values);
    return measure == "values" || measure == "left_out" ? average * static_cast<double>(values.size()) : average;
}

void set_measure(MeasuredThing& thing, const std::string& name, double value) {
    for (auto& [known, old] : thing.measures) {
        if (known == name) old = value;
    }
}

void set_error(MeasuredThing& thing, const ReferencedError& error) {
    set_measure(thing, "unbiased_mse", error.mse);
    set_measure(thing, "unbiased_mse_lower", error.lower);
    set_measure(thing, "unbiased_mse_upper", error.upper);
    set_measure(thing, "unbiased_rmse", std::sqrt(std::max(error.mse, 0.0)));
    set_measure(thing, "reference_noise_mse", error.reference_noise_mse);
    set_measure(thing, "noise_ratio", error.ratio);
    set_measure(thing, "trustworthy", error.trustworthy ? 1.0 : 0.0);
}

void whole_images_first(std::vector<MeasuredThing>& things) {
    std::stable_partition(things.begin(), things.end(),
                          [](const MeasuredThing& thing) { return thing.region.empty(); });
}

void add_measures(MeasuredThing& thing, const PathStabilityResult& result) {
    const double values[] = {
        result.flicker.value,           result.flicker.lower,           result.flicker.upper,
        result.method_warping.value,    result.truth_warping.value,     result.temporal_variance.value,
        result.temporal_variance.lower, result.temporal_variance.upper, result.noise,
        result.trustworthy ? 1.0 : 0.0};
    for (std::size_t i = 0; i < stability_names().size(); ++i) {
        const std::string& name = stability_names()[i];
        std::erase_if(thing.measures, [&](const auto& measure) { return measure.first == name; });  // of one frame
        thing.measures.emplace_back(name, values[i]);
    }
}

}  // namespace

const std::vector<std::string>& stability_names() {
    static const std::vector<std::string> names = {
        "flicker",       "flicker_lower",      "flicker_upper",           "method_warping",
        "truth_warping", "temporal_variance",  "temporal_variance_lower", "temporal_variance_upper",
        "flicker_noise", "flicker_trustworthy"};
    return names;
}

void SequenceComparison::add(const std::string& name, const Frame& test, const Frame& reference) {
    const FrameComparison comparison = compare_frames(test, reference, settings_.comparison);
    if (frames_.empty()) {
        only_in_test_ = comparison.only_in_test;
        only_in_reference_ = comparison.only_in_reference;
    }
    MeasuredFrame frame{name, {}};
    std::vector<Region> regions;
    if (settings_.regions) {
        const bool follows = before_ && knows_motion(reference);
        regions = regions_of(reference, follows ? &*before_ : nullptr, settings_.region_settings);
    }
    std::vector<std::string> planes;
    for (const PlaneComparison& plane : comparison.planes) {
        planes.push_back(plane.plane);
        MeasuredThing& thing = frame.things.emplace_back(MeasuredThing{plane.plane, "", plane.measures()});
        add_to_series(test, reference, plane.plane, "", settings_.comparison.referenced.mask);
        if (knows_motion(reference) && !is_geometry_plane(plane.plane)) add_stability(test, reference, regions, thing);
    }
    if (has_gbuffer(test, reference)) {
        GbufferFidelitySettings fidelity;
        fidelity.mask = settings_.comparison.referenced.mask;
        for (const LayerFidelity& layer : gbuffer_fidelity(test, reference, fidelity))
            frame.things.push_back({layer.layer, "", layer.measures()});
    }
    add_regions(test, reference, planes, regions, frame);
    frames_.push_back(std::move(frame));
}

void SequenceComparison::add_regions(const Frame& test, const Frame& reference, const std::vector<std::string>& planes,
                                     const std::vector<Region>& regions, MeasuredFrame& frame) {
    for (const Region& region : regions) {
        ComparisonSettings inside = settings_.comparison;
        inside.flip = FlipRange::none;  // it would be made of the whole image again for every region
        inside.referenced.mask = &region.mask;
        for (const std::string& plane : planes) {
            const Image &image = test.plane(plane), &truth = reference.plane(plane);
            if (region.pixels == 0 || !has_values(image, truth, region.mask)) continue;
            PlaneComparison comparison = compare_planes(image, truth, inside, plane);
            if (has_halves(reference, plane)) {
                comparison.referenced =
                    referenced_error(test, reference, plane, samples_of(reference), inside.referenced);
            }
            frame.things.push_back({plane, region.name, comparison.measures()});
            add_to_series(test, reference, plane, region.name, &region.mask);
        }
    }
    if (regions.empty() || !reference.has("position")) return;
    before_.emplace(reference.width(), reference.height());
    before_->set("position", reference.plane("position"));
}

void SequenceComparison::add_to_series(const Frame& test, const Frame& reference, const std::string& plane,
                                       const std::string& region, const Image* mask) {
    if (!has_halves(reference, plane)) return;
    const std::string key = MeasuredThing{plane, region, {}}.full_name();
    errors_.try_emplace(key, SeriesOf::frames, settings_.comparison.referenced)
        .first->second.add(test, reference, plane, samples_of(reference), mask);
}

void SequenceComparison::add_stability(const Frame& test, const Frame& reference, const std::vector<Region>& regions,
                                       MeasuredThing& thing) {
    PathStability& stability = stability_.try_emplace(thing.name, thing.name, settings_.stability).first->second;
    const auto flicker = stability.add(test, reference, settings_.comparison.referenced.mask, regions);
    if (!flicker) return;
    thing.measures.insert(thing.measures.end(), {{"flicker", flicker->rms},
                                                 {"flicker_lower", flicker->rms_lower},
                                                 {"flicker_upper", flicker->rms_upper},
                                                 {"method_warping", flicker->method_warping},
                                                 {"truth_warping", flicker->truth_warping},
                                                 {"flicker_noise", flicker->noise}});
}

std::optional<ReferencedError> SequenceComparison::error_of(const std::string& plane) const {
    const auto found = errors_.find(plane);
    if (found == errors_.end() || found->second.members() == 0) return std::nullopt;
    return found->second.error();
}

std::vector<MeasuredThing> SequenceComparison::whole() const {
    if (frames_.size() == 1) {
        std::vector<MeasuredThing> things = frames_.front().things;
        whole_images_first(things);
        return things;
    }
    // Regions may be missing in some frames: their order is that of their first appearance.
    std::vector<MeasuredThing> things;
    std::map<std::string, std::map<std::string, std::vector<double>>> values;  // full name, measure
    for (const MeasuredFrame& frame : frames_) {
        for (const MeasuredThing& thing : frame.things) {
            const std::string key = thing.full_name();
            if (!values.contains(key)) things.push_back({thing.name, thing.region, thing.measures});
            for (const auto& [measure, value] : thing.measures) values[key][measure].push_back(value);
        }
    }
    std::map<std::string, std::map<std::string, PathStabilityResult>> of_regions;  // by plane
    for (MeasuredThing& thing : things) {
        const std::string key = thing.full_name();
        auto& of_thing = values.at(key);
        for (auto& [measure, value] : thing.measures) value = over_frames(measure, of_thing.at(measure));
        if (of_thing.contains("psnr")) {
            set_measure(thing, "psnr",
                        10.0 * std::log10(mean_square(of_thing.at("data_range")) / mean(of_thing.at("mse"))));
        }
        if (const auto error = errors_.find(key); error != errors_.end() && error->second.members() > 0)
            set_error(thing, error->second.error());
        const auto stability = stability_.find(thing.name);
        if (stability == stability_.end()) continue;
        if (thing.region.empty()) {
            add_measures(thing, stability->second.result());
        } else {
            auto [regions, is_new] = of_regions.try_emplace(thing.name);
            if (is_new) regions->second = stability->second.of_regions();
            if (const auto region = regions->second.find(thing.region); region != regions->second.end())
                add_measures(thing, region->second);
        }
    }
    whole_images_first(things);
    return things;
}

}  // namespace plumb
