// The formulas of the specular lobe, for both renderers: a GGX microfacet surface of single scattering.
//
//     f(wo, wi) = F(wo.h) D(n.h) V(n.wo, n.wi),   h = normalize(wo + wi),   V = G2 / (4 n.wo n.wi)
//
// F is Schlick's Fresnel term with reflectance f0 at normal and f90 at grazing incidence, D the isotropic GGX
// distribution of normals, G2 Smith's height-correlated masking and shadowing. All are written without a division by
// n.wo or n.wi, so that they are finite and accurate down to the horizon itself.
//   Sources: Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces" (D); Heitz 2014,
//   "Understanding the Masking-Shadowing Function", equations 72 and 99 (G1, G2); Lagarde, de Rousiers 2014, "Moving
//   Frostbite to Physically Based Rendering", listing 2 (V); Schlick 1994 (F); glTF 2.0, appendix B (alpha =
//   roughness^2).
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

namespace plumb {

// Below this alpha (perceptual roughness 0.0316) a surface is an ideal mirror: a lobe without density. The lobe is then
// narrower than 0.12 degrees, a pixel or two of a usual view; and the rounding of wo and wi to float (6e-8 per
// component) turns h by 1e-7, which at this alpha already moves D by 0.05 %.
constexpr float smallest_ggx_alpha = 1e-3f;

// Of a perceptual roughness in [0, 1]. 0: a mirror.
inline float ggx_alpha(float roughness) {
    const float alpha = roughness * roughness;
    return alpha < smallest_ggx_alpha ? 0.0f : std::min(alpha, 1.0f);
}

// D: area of microfacets with normal h per macroscopic area and solid angle. The sine is asked for by itself because
// 1 - cosine^2 would have lost all digits where D is largest.
template <typename Real>
Real ggx_distribution(Real cosine_h, Real squared_sine_h, Real alpha) {
    const Real a2 = alpha * alpha;
    const Real t = squared_sine_h + a2 * cosine_h * cosine_h;
    return a2 / (glm::pi<Real>() * t * t);
}

// sqrt(alpha^2 + (1 - alpha^2) c^2), of which Smith's terms are made: G1(c) = 2 c / (c + smith_root(c)), which is
// 1 / (1 + Lambda(c)).
template <typename Real>
Real smith_root(Real cosine, Real alpha) {
    const Real a2 = alpha * alpha;
    return std::sqrt(a2 + (Real(1) - a2) * cosine * cosine);
}

// V from n.wo, n.wi >= 0 and their smith_root.
template <typename Real>
Real smith_visibility(Real cosine_o, Real root_o, Real cosine_i, Real root_i) {
    return Real(0.5) / (cosine_o * root_i + cosine_i * root_o);
}

// The share of f90 in the Fresnel term: F = f0 + (f90 - f0) schlick_weight(wo.h).
template <typename Real>
Real schlick_weight(Real cosine) {
    const Real x = std::clamp(Real(1) - cosine, Real(0), Real(1));
    const Real squared = x * x;
    return squared * squared * x;
}

inline glm::vec3 schlick_fresnel(const glm::vec3& f0, const glm::vec3& f90, float cosine) {
    return f0 + (f90 - f0) * schlick_weight(cosine);
}

// The normal about which the lobe is taken when seen from `wo`. An interpolated normal may lean away from the viewer;
// it is then turned just far enough that the viewer lies on the horizon, where the lobe is still defined. The lobe
// changes continuously and no black seam appears.
inline glm::vec3 lobe_normal(const glm::vec3& shading_normal, const glm::vec3& wo) {
    const float cosine = glm::dot(shading_normal, wo);
    return cosine >= 0.0f ? shading_normal : glm::normalize(shading_normal - cosine * wo);
}

}  // namespace plumb
