#include "rasterizer/ambient_light.h"

namespace plumb {

std::string_view to_string(AmbientSource source) {
    switch (source) {
        case AmbientSource::none:
            return "none";
        case AmbientSource::ambient:
            return "ambient";
        case AmbientSource::environment:
            return "environment";
        case AmbientSource::probe:
            return "probe";
    }
    return "";
}

AmbientLight::AmbientLight(const PassResources& resources, AmbientSource source, float radiance, GLuint unit)
    : source_(source), radiance_(radiance), unit_(unit) {
    for (const std::string& plane : inputs(source)) cube_ = &resources.planes.get(plane);
}

ShaderDefines AmbientLight::defines() const {
    if (source_ == AmbientSource::none) return {};
    if (cube_) return {{"AMBIENT_CUBE_UNIT", std::to_string(unit_)}};
    return {{"AMBIENT_RADIANCE", shader_literal(radiance_)}};
}

void AmbientLight::bind() const {
    if (cube_) cube_->bind(unit_);
}

std::vector<std::string> AmbientLight::inputs(AmbientSource source) {
    if (source == AmbientSource::environment) return {"environment.irradiance"};
    if (source == AmbientSource::probe) return {"probe.irradiance"};
    return {};
}

}  // namespace plumb
