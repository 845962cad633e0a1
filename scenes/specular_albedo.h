// Directional albedo of the specular lobe: what share of light from one direction it reflects in all.
//
//     E(wo) = integral over the hemisphere of f(wo, wi) cos(wi) = f0 A + f90 B,   A, B functions of n.wo and alpha
//
// Both renderers scale the diffuse lobe seen from wo by 1 - E(wo), so that a surface never gives back more than it
// gets. The table is therefore a part of the material model: it lies within `error_bound` of the integral (which keeps
// the sum of both lobes that close to energy conservation), but is the same numbers wherever it is read.
//
// A and B are tabulated over (n.wo, alpha) and read bilinearly. Near the horizon they change within n.wo ~ alpha
// however small alpha is, so columns are spaced by asinh(n.wo / k), k = alpha / (1 + 8 alpha), each row in its own way;
// rows are spaced by alpha^(1/4).
//   Source of the split: Karis 2013, "Real Shading in Unreal Engine 4".
#pragma once

#include <cmath>
#include <vector>

#include <glm/glm.hpp>

#include "scenes/ggx.h"

namespace plumb {

class SpecularAlbedo {
public:
    static constexpr int columns = 48, rows = 24;
    static constexpr float error_bound = 4e-3f;  // of A, of B and of their sum

    // Integrates the table; takes some 20 ms.
    SpecularAlbedo();

    // (A, B) for 0 <= cosine_o <= 1 and an alpha of ggx_alpha; exact for a mirror.
    glm::vec2 split(float cosine_o, float alpha) const;
    glm::vec3 albedo(const glm::vec3& f0, const glm::vec3& f90, float cosine_o, float alpha) const {
        const glm::vec2 share = split(cosine_o, alpha);
        return share.x * f0 + share.y * f90;
    }

    // Row by row, alpha growing, within a row n.wo growing: for a texture of columns x rows texels whose centres lie at
    // table_coordinates() = i / (columns - 1), j / (rows - 1).
    const std::vector<glm::vec2>& table() const { return table_; }
    // Both in [0, 1]; not for mirrors.
    static glm::vec2 table_coordinates(float cosine_o, float alpha);

private:
    std::vector<glm::vec2> table_;
};

// The same by quadrature with `order` Gauss points per axis; what the table is made of and checked against.
glm::dvec2 integrate_specular_albedo(double cosine_o, double alpha, int order);

}  // namespace plumb
