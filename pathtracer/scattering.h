// How light is scattered at a vertex that has a specular lobe or lets light pass, next to its diffuse lobe.
//
// Which lobe a path goes on with is chosen by how much each reflects; a direction that both could have drawn counts
// with the sum of their densities.
#pragma once

#include <algorithm>

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "pathtracer/direction_sampling.h"
#include "pathtracer/microfacet.h"
#include "pathtracer/path_batch.h"

namespace plumb {

// Of a colour's channels.
inline float largest(const glm::vec3& v) { return std::max(v.x, std::max(v.y, v.z)); }

struct ScatterSample {
    glm::vec3 direction{0.0f};
    glm::vec3 weight{0.0f};  // BSDF times cosine over density; 0: the path ends
    float density = 0.0f;    // per solid angle; 0: no other strategy finds this direction
    bool passes = false;     // straight through the surface
};

class Scattering {
public:
    // `albedo`: of the diffuse lobe (0: leave it out); `specular_albedo`: of the specular one from this side;
    // `transmission`: of light that passes (0: leave it out).
    Scattering(const SpecularVertex& vertex, const glm::vec3& shading_normal, const glm::vec3& albedo,
               const glm::vec3& specular_albedo, const glm::vec3& transmission)
        : lobe_(vertex.surface.f0, vertex.surface.f90, vertex.surface.alpha, shading_normal, vertex.to_viewer),
          normal_(shading_normal),
          to_viewer_(vertex.to_viewer),
          albedo_(albedo),
          transmission_(transmission) {
        const float diffuse = largest(albedo), specular = largest(specular_albedo), passing = largest(transmission);
        const float sum = diffuse + specular + passing;
        if (!(sum > 0.0f)) return;
        specular_share_ = specular / sum;
        passing_share_ = passing / sum;
        diffuse_share_ = diffuse > 0.0f ? 1.0f - specular_share_ - passing_share_ : 0.0f;
    }

    // BSDF times cosine, and the density with which sample() draws `direction`; without what passes straight through.
    SpecularLobeValue evaluate(const glm::vec3& direction) const {
        SpecularLobeValue value = lobe_.evaluate(direction);
        value.density *= specular_share_;
        const float diffuse = std::max(0.0f, glm::dot(normal_, direction)) * glm::one_over_pi<float>();
        value.reflected += albedo_ * diffuse;
        value.density += diffuse_share_ * diffuse;
        return value;
    }

    ScatterSample sample(float pick, glm::vec2 u) const {
        ScatterSample sample;
        if (pick < passing_share_) {
            sample.direction = -to_viewer_;
            sample.weight = transmission_ / passing_share_;
            sample.passes = true;
            return sample;
        }
        if (pick < passing_share_ + specular_share_) {
            const SpecularLobeSample drawn = lobe_.sample(u);
            sample.direction = drawn.direction;
            if (lobe_.is_mirror()) {
                sample.weight = drawn.weight / specular_share_;
                return sample;
            }
            if (drawn.weight == glm::vec3(0.0f)) return sample;
        } else {
            if (!(diffuse_share_ > 0.0f)) return sample;
            sample.direction = sample_cosine_hemisphere(normal_, u);
        }
        const SpecularLobeValue value = evaluate(sample.direction);
        if (!(value.density > 0.0f)) return sample;
        sample.weight = value.reflected / value.density;
        sample.density = value.density;
        return sample;
    }

private:
    SpecularLobe lobe_;
    glm::vec3 normal_, to_viewer_, albedo_, transmission_;
    float diffuse_share_ = 0.0f, specular_share_ = 0.0f, passing_share_ = 0.0f;
};

}  // namespace plumb
