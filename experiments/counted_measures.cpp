#include "experiments/counted_measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "experiments/depth_normals.h"
#include "experiments/exact_surfaces.h"
#include "experiments/statistics.h"
#include "metrics/regions.h"
#include "pathtracer/reference.h"
#include "pathtracer/traced_scene.h"
#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/light_fragment_count.h"
#include "rasterizer/pipeline.h"

namespace plumb {
namespace {

using Measures = std::vector<std::pair<std::string, double>>;

// Of one scene of the experiment; what takes time is made when it is first asked for.
class SceneCounter {
public:
    SceneCounter(const Experiment& experiment, const ExperimentScene& entry, const Scene& scene, GlContext& context)
        : experiment_(experiment), entry_(entry), scene_(scene), context_(context) {}

    Measures light_fragments(const Method& method, const View& view) {
        return {{"light fragments", static_cast<double>(count_light_fragments(context_, scene_, method, view))}};
    }

    Measures shadow_map_bytes(const Method& method, const View&) {
        const Pipeline pipeline = pipeline_of(method, {experiment_.planes.front()});
        return {{"shadow map bytes", static_cast<double>(pipeline.shadow_map_bytes())}};
    }

    Measures depth_complexity(const Method&, const View& view) {
        return {{"depth complexity", surfaces_per_pixel(traced(), view)}};
    }

    Measures back_faces(const Method& method, const View& view) {
        const float separation = separation_in_metres(method.gbuffer, view.camera());
        return {{"back faces", back_face_share(traced(), view, separation)}};
    }

    Measures depth_normals(const Method& method, const View& view) {
        Pipeline pipeline = pipeline_of(method, {"depth"});
        const Image depth = pipeline.render(view).frame.plane("depth");
        return {{"depth normal degrees", depth_normal_degrees(depth, exact(view), view)}};
    }

    Measures confidence(const Method& method, const View& view) {
        if (!method.radiosity.enabled) return {};
        Pipeline pipeline = pipeline_of(method, {"confidence"});
        const Image confidence = pipeline.render(view).frame.plane("confidence");
        const Frame& gbuffer = exact(view);
        const Image& depth = gbuffer.plane("depth");
        Measures measures;
        const auto add = [&](const std::string& name, const auto& counts) {
            double sum = 0.0, pixels = 0.0;
            for (std::size_t i = 0; i < depth.values().size(); ++i) {
                if (std::isfinite(depth.values()[i]) && counts(i)) sum += confidence.values()[i], ++pixels;
            }
            measures.emplace_back(name, sum / pixels);  // not finite, and so left out, where there is no pixel
        };
        add("confidence", [](std::size_t) { return true; });
        for (const Region& region : regions_of(gbuffer))
            add("confidence in " + region.name, [&](std::size_t i) { return region.mask.values()[i] > 0.0f; });
        std::vector<double> depths;
        std::ranges::copy_if(depth.values(), std::back_inserter(depths), [](float d) { return std::isfinite(d); });
        if (depths.empty()) return measures;
        const double median = quantile(std::move(depths), 0.5);
        add("confidence in near_half", [&](std::size_t i) { return depth.values()[i] < median; });
        add("confidence in far_half", [&](std::size_t i) { return depth.values()[i] >= median; });
        return measures;
    }

private:
    Pipeline pipeline_of(const Method& method, std::vector<std::string> planes) {
        Quantities quantities = quantities_of(experiment_, entry_, planes.front());
        quantities.planes = std::move(planes);
        return {context_, scene_, method, quantities, experiment_.width, experiment_.height};
    }
    const TracedScene& traced() {
        if (!traced_) traced_.emplace(scene_);
        return *traced_;
    }
    const Frame& exact(const View& view) {
        if (!tracer_) tracer_.emplace(scene_);
        const auto [place, is_new] = exact_.try_emplace(view.camera().name);
        if (is_new) place->second = tracer_->gbuffer(view, {.minimum_separation = entry_.minimum_separation});
        return place->second;
    }

    const Experiment& experiment_;
    const ExperimentScene& entry_;
    const Scene& scene_;
    GlContext& context_;
    std::optional<TracedScene> traced_;
    std::optional<PathTracer> tracer_;
    std::map<std::string, Frame> exact_;  // by view
};

struct CountedMeasure {
    std::string_view name;  // that all of its measures begin with
    Measures (SceneCounter::*count)(const Method&, const View&);
};
constexpr std::array<CountedMeasure, 6> counted_measures = {{{"light fragments", &SceneCounter::light_fragments},
                                                             {"shadow map bytes", &SceneCounter::shadow_map_bytes},
                                                             {"depth complexity", &SceneCounter::depth_complexity},
                                                             {"back faces", &SceneCounter::back_faces},
                                                             {"depth normal degrees", &SceneCounter::depth_normals},
                                                             {"confidence", &SceneCounter::confidence}}};

}  // namespace

void add_counted_measures(const Experiment& experiment, LoadedScenes& scenes, GlBackend backend,
                          const std::function<bool(std::string_view)>& is_asked_for, std::vector<Cell>& cells) {
    std::vector<CountedMeasure> asked;
    std::ranges::copy_if(counted_measures, std::back_inserter(asked), is_asked_for, &CountedMeasure::name);
    if (asked.empty()) return;
    const std::unique_ptr<GlContext> context = GlContext::create(backend);
    for (const ExperimentScene& entry : experiment.scenes) {
        const Scene& scene = scenes.load(entry.scene);
        SceneCounter counter(experiment, entry, scene, *context);
        std::map<std::pair<std::string, std::string>, Measures> counted;  // by view and method
        for (Cell& cell : cells) {
            const Method* method = find_method(experiment.methods, cell.method);
            const auto camera = std::ranges::find(scene.cameras, cell.place, &Camera::name);
            if (cell.scene != entry.scene || !method || camera == scene.cameras.end()) continue;
            const auto [place, is_new] = counted.try_emplace({cell.place, cell.method});
            if (is_new) {
                const Method in_scene = method_in_scene(*method, entry, experiment.file.string());
                const View view(*camera, experiment.width, experiment.height);
                for (const CountedMeasure& measure : asked) {
                    for (auto& value : (counter.*measure.count)(in_scene, view))
                        place->second.push_back(std::move(value));
                }
            }
            for (const auto& [name, value] : place->second) cell.set(name, value);
        }
        scenes.release(entry.scene);
    }
}

}  // namespace plumb
