#include "experiments/sequence_comparison.h"

#include <algorithm>

namespace plumb {
namespace {

bool knows_motion(const Frame& reference) {
    return reference.has("motion") && reference.has("position") && reference.has("depth");
}

void whole_images_first(std::vector<MeasuredThing>& things) {
    std::stable_partition(things.begin(), things.end(),
                          [](const MeasuredThing& thing) { return thing.region.empty(); });
}

void add_measures(MeasuredThing& thing, const PathStabilityResult& result) {
    for (const auto& of_path : result.measures()) {
        std::erase_if(thing.measures, [&](const auto& of_frame) { return of_frame.first == of_path.first; });
        thing.measures.push_back(of_path);
    }
}

}  // namespace

void SequenceComparison::add(const std::string& name, const Frame& test, const Frame& reference) {
    const PlanePairs planes = pair_planes(test, reference);
    if (frames_.empty()) {
        only_in_test_ = planes.only_in_test;
        only_in_reference_ = planes.only_in_reference;
    }
    MeasuredFrame frame{name, {}};
    std::vector<Region> regions;
    if (settings_.regions) {
        const bool follows = before_ && knows_motion(reference);
        regions = regions_of(reference, follows ? &*before_ : nullptr, settings_.region_settings);
    }
    for (const std::string& plane : planes.common) add_plane(test, reference, plane, regions, frame);
    if (has_gbuffer(test, reference)) {
        GbufferFidelitySettings fidelity;
        fidelity.bootstrap = settings_.comparison.referenced.bootstrap;
        fidelity.mask = settings_.comparison.referenced.mask;
        fidelity.keep_blocks = true;
        for (const LayerFidelity& layer : gbuffer_fidelity(test, reference, fidelity)) {
            frame.things.push_back({layer.layer, "", layer.measures()});
            layers_[layer.layer].add(layer);
        }
    }
    whole_images_first(frame.things);
    frames_.push_back(std::move(frame));
    if (regions.empty() || !reference.has("position")) return;
    before_.emplace(reference.width(), reference.height());
    before_->set("position", reference.plane("position"));
}

void SequenceComparison::add_plane(const Frame& test, const Frame& reference, const std::string& plane,
                                   const std::vector<Region>& regions, MeasuredFrame& frame) {
    PlaneSeries& series = errors_.try_emplace(plane, plane, SeriesOf::frames, settings_.comparison).first->second;
    const auto first = frame.things.size();
    for (const PlaneComparison& comparison : series.add(test, reference, regions))
        frame.things.push_back({plane, comparison.region, comparison.measures()});
    if (knows_motion(reference) && !is_geometry_plane(plane))
        add_stability(test, reference, regions, frame.things[first]);
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
    return found == errors_.end() ? std::nullopt : found->second.error();
}

std::vector<MeasuredThing> SequenceComparison::whole() const {
    if (frames_.size() == 1) return frames_.front().things;
    std::vector<MeasuredThing> things;
    for (const auto& [plane, series] : errors_) {
        const auto stability = stability_.find(plane);
        const auto of_regions =
            stability == stability_.end() ? decltype(stability->second.of_regions()){} : stability->second.of_regions();
        for (PlaneSeriesResult& part : series.results()) {
            MeasuredThing& thing = things.emplace_back(MeasuredThing{plane, part.region, std::move(part.measures)});
            if (part.region.empty() && stability != stability_.end()) add_measures(thing, stability->second.result());
            if (const auto region = of_regions.find(part.region); region != of_regions.end())
                add_measures(thing, region->second);
        }
    }
    for (const auto& [layer, series] : layers_)
        things.push_back({layer, "", series.result(settings_.comparison.referenced.bootstrap).measures()});
    whole_images_first(things);
    return things;
}

}  // namespace plumb
