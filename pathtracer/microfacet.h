// The specular lobe at one vertex of a path, seen from one direction: evaluation, sampling, density.
//
// The formulas are those of scenes/ggx.h. Directions are drawn by reflecting wo about a visible microfacet normal, so a
// sample weighs F G2 / G1 <= 1, whatever the angle. Microfacets send some of these directions below the horizon, where
// the light would have to be scattered again; single scattering loses it, and such samples weigh 0.
//   Source of the sampling: Heitz 2018, "Sampling the GGX Distribution of Visible Normals"; Dupuy, Benyoub 2023,
//   "Sampling Visible GGX Normals with Spherical Caps". Their cap is filled through a disc here, which keeps neighbours
//   neighbours and needs no trigonometry.
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>

#include "pathtracer/direction_sampling.h"
#include "scenes/ggx.h"

namespace plumb {

struct SpecularLobeValue {
    glm::vec3 reflected{0.0f};  // f(wo, wi) times the cosine of wi
    float density = 0.0f;       // with which sample() draws wi, per solid angle
};

struct SpecularLobeSample {
    glm::vec3 direction{0.0f};  // unit
    glm::vec3 weight{0.0f};     // f cosine / density; 0: below the horizon, the path ends
    float density = 0.0f;       // per solid angle; of a mirror 0: no other strategy finds this direction
};

class SpecularLobe {
public:
    // `alpha` as ggx_alpha gives it: 0, or in [smallest_ggx_alpha, 1]. `shading_normal` and `wo` are unit vectors; wo
    // points away from the surface and may lie below the shading normal's horizon (see lobe_normal).
    SpecularLobe(const glm::vec3& f0, const glm::vec3& f90, float alpha, const glm::vec3& shading_normal,
                 const glm::vec3& wo)
        : f0_(f0),
          f90_(f90),
          normal_(lobe_normal(shading_normal, wo)),
          wo_(wo),
          alpha_(alpha),
          cosine_o_(std::max(0.0f, glm::dot(normal_, wo))),
          root_o_(smith_root(cosine_o_, alpha)) {}

    bool is_mirror() const { return alpha_ == 0.0f; }
    float cosine_o() const { return cosine_o_; }  // what the directional albedo is to be asked with

    // Both 0 for a mirror, and for wi on or below the horizon.
    SpecularLobeValue evaluate(const glm::vec3& wi) const {
        const float cosine_i = glm::dot(normal_, wi);
        if (is_mirror() || !(cosine_i > 0.0f)) return {};
        const glm::vec3 sum = wo_ + wi;
        const float length = glm::length(sum);
        if (!(length > 0.0f)) return {};  // light that grazes past the surface, straight at the viewer
        const glm::vec3 half_vector = sum / length;
        const glm::vec3 across = glm::cross(normal_, half_vector);
        return value(cosine_i, half_vector, glm::dot(normal_, half_vector), glm::dot(across, across));
    }

    SpecularLobeSample sample(glm::vec2 u) const {
        if (is_mirror()) {
            const glm::vec3 direction = 2.0f * cosine_o_ * normal_ - wo_;
            return {direction, schlick_fresnel(f0_, f90_, cosine_o_), 0.0f};
        }
        glm::vec3 tangent, bitangent;
        complete_basis(normal_, tangent, bitangent);
        // Stretched by alpha the surface is a hemisphere, and the normals visible from `view` are half way between it
        // and the cap of directions z > -view.z, uniformly.
        const glm::vec3 view =
            glm::normalize(glm::vec3(alpha_ * glm::dot(tangent, wo_), alpha_ * glm::dot(bitangent, wo_), cosine_o_));
        const glm::vec2 disc = sample_disc(u);
        const float height = std::max(0.0f, 1.0f - glm::dot(disc, disc)) * (1.0f + view.z);  // cap.z + view.z
        const glm::vec2 cap = disc * std::sqrt((1.0f + view.z) * (height + (1.0f - view.z)));
        const glm::vec3 stretched(alpha_ * (cap.x + view.x), alpha_ * (cap.y + view.y), height);
        const float length = glm::length(stretched);
        if (!(length > 0.0f)) return {};
        const glm::vec3 local = stretched / length;
        const glm::vec3 half_vector = local.x * tangent + local.y * bitangent + local.z * normal_;

        SpecularLobeSample sample;
        sample.direction = glm::normalize(2.0f * glm::dot(wo_, half_vector) * half_vector - wo_);
        const float cosine_i = glm::dot(normal_, sample.direction);
        if (!(cosine_i > 0.0f)) return sample;
        const SpecularLobeValue there = value(cosine_i, half_vector, local.z, local.x * local.x + local.y * local.y);
        sample.density = there.density;
        sample.weight = there.reflected / there.density;
        return sample;
    }

private:
    SpecularLobeValue value(float cosine_i, const glm::vec3& half_vector, float cosine_h, float squared_sine_h) const {
        const float distribution = ggx_distribution(cosine_h, squared_sine_h, alpha_);
        const float visibility = smith_visibility(cosine_o_, root_o_, cosine_i, smith_root(cosine_i, alpha_));
        const glm::vec3 fresnel = schlick_fresnel(f0_, f90_, glm::dot(wo_, half_vector));
        // G1(wo) D / (4 n.wo), as the reflection about visible normals has it.
        return {fresnel * (distribution * visibility * cosine_i), 0.5f * distribution / (cosine_o_ + root_o_)};
    }

    glm::vec3 f0_, f90_, normal_, wo_;
    float alpha_, cosine_o_, root_o_;
};

}  // namespace plumb
