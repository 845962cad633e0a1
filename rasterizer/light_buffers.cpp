#include "rasterizer/light_buffers.h"

#include <fmt/format.h>

#include "rasterizer/shadow_pass.h"

namespace plumb {
namespace {

struct ShadowUnit {
    const char* texture;
    GLuint unit;  // of shadow_lookup.glsl, and of direct_light.frag for emitters
};
constexpr std::array<ShadowUnit, 4> shadow_units{
    {{"shadow.points", 3}, {"shadow.maps", 4}, {"shadow.emitters", 5}, {"shadow.paraboloids", 7}}};

DirectSettings settings_of(const Method& method, LightKinds kinds) {
    DirectSettings settings = method.direct;
    settings.emitters = settings.emitters && kinds == LightKinds::all;
    return settings;
}

template <typename Record>
GlBuffer changing_buffer(GlContext& context, const std::vector<Record>& records) {
    return GlBuffer::from(context, records, GL_DYNAMIC_STORAGE_BIT);
}

template <typename Record>
void rewrite(const GlBuffer& buffer, const std::vector<Record>& records) {
    buffer.write(0, records.size() * sizeof(Record), records.data());
}

}  // namespace

LightBuffers::LightBuffers(const PassResources& resources, LightKinds kinds)
    : settings_(settings_of(resources.method, kinds)),
      lights_(resources.scene, settings_),
      moving_(resources.scene, settings_),
      points_(GlBuffer::from(resources.context, lights_.points)),
      spots_(GlBuffer::from(resources.context, lights_.spots)),
      directionals_(GlBuffer::from(resources.context, lights_.directionals)),
      emitters_(GlBuffer::from(resources.context, lights_.emitters)),
      pieces_(changing_buffer(resources.context, lights_.pieces)),
      emitter_cubes_(changing_buffer(resources.context, lights_.emitter_cube_records)) {
    for (std::size_t i = 0; i < shadow_units.size(); ++i) shadows_[i] = resources.planes.find(shadow_units[i].texture);
}

ShaderDefines LightBuffers::shadow_defines() const { return plumb::shadow_defines(lights_, settings_.shadow); }

void LightBuffers::bind(const std::optional<double>& time) {
    if (moving_.move_to(time, lights_)) {
        rewrite(pieces_, lights_.pieces);
        rewrite(emitter_cubes_, lights_.emitter_cube_records);
    }
    const std::array<const GlBuffer*, 6> buffers{&points_,   &spots_,  &directionals_,
                                                 &emitters_, &pieces_, &emitter_cubes_};
    for (std::size_t i = 0; i < buffers.size(); ++i) buffers[i]->bind(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(i));
    for (std::size_t i = 0; i < shadows_.size(); ++i) {
        if (shadows_[i]) shadows_[i]->bind(shadow_units[i].unit);
    }
}

ShaderDefines light_count_defines(const LightSet& lights, bool local) {
    ShaderDefines defines;
    const auto add = [&](const char* name, std::size_t count) {
        if (count > 0) defines.emplace_back(name, fmt::format("{}", count));
    };
    if (local) {
        add("POINT_LIGHTS", lights.points.size());
        add("SPOT_LIGHTS", lights.spots.size());
    }
    add("DIRECTIONAL_LIGHTS", lights.directionals.size());
    add("EMITTERS", lights.emitters.size());
    return defines;
}

}  // namespace plumb
