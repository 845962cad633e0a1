#include "rasterizer/light_fragment_count.h"

#include <memory>
#include <optional>
#include <vector>

#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/gl_context.h"
#include "rasterizer/light_volume_pass.h"
#include "rasterizer/pass_plan.h"
#include "rasterizer/passes.h"
#include "rasterizer/scene_geometry.h"
#include "rasterizer/view_uniforms.h"

namespace plumb {

std::uint64_t count_light_fragments(GlContext& context, const Scene& scene, const Method& method, const View& view) {
    if (!uses_light_volumes(scene, method)) {
        const std::uint64_t lights = scene.point_lights.size() + scene.spot_lights.size();
        return lights * static_cast<std::uint64_t>(view.width()) * static_cast<std::uint64_t>(view.height());
    }
    context.make_current();
    Quantities quantities;
    quantities.planes = {"direct"};
    const std::vector<PassDeclaration> declarations = declare_passes(scene, method, quantities);
    const PassPlan plan = plan_passes(declarations, quantities.planes);
    const View wide = view.with_guard_band(method.gbuffer.guard_band);
    PlaneTextures planes(context, wide.width(), wide.height());
    ProgramCache programs(context, gbuffer_defines(method));
    std::optional<SceneGeometry> geometry;
    const PassResources resources{
        context, scene, method, quantities, planes, programs, plan.read, [&]() -> const SceneGeometry& {
            if (!geometry) geometry.emplace(context, scene);
            return *geometry;
        }};
    std::vector<std::unique_ptr<Pass>> passes;
    const LightVolumePass* counting = nullptr;
    for (const std::size_t index : plan.order) {
        if (declarations[index].name == "light volumes") {
            auto pass = std::make_unique<LightVolumePass>(resources, 0, true);
            counting = pass.get();
            passes.push_back(std::move(pass));
        } else {
            passes.push_back(declarations[index].create(resources));
        }
    }
    const ViewUniforms view_uniforms(context);
    view_uniforms.update(wide, wide, method.gbuffer.guard_band);
    for (std::size_t i = 0; i < passes.size(); ++i) {
        view_uniforms.bind();
        passes[i]->execute({wide, wide});
        context.check(declarations[plan.order[i]].name);
    }
    return counting ? counting->fragments_shaded() : 0;
}

}  // namespace plumb
