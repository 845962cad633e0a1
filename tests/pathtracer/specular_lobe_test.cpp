// The specular lobe: its formulas, its energy, and the table of its directional albedo.
#include <gtest/gtest.h>

#include "chi_square.h"
#include "direction_cells.h"
#include "pathtracer/microfacet.h"
#include "pathtracer/scattering.h"
#include "scenes/specular_albedo.h"

namespace plumb {
namespace {

const glm::vec3 normal = glm::normalize(glm::vec3(2, -1, 3));

// The direction at that cosine to the normal, turned about it.
glm::vec3 direction_at(float cosine, float azimuth = 0.6f) {
    glm::vec3 tangent, bitangent;
    complete_basis(normal, tangent, bitangent);
    const float sine = std::sqrt(1.0f - cosine * cosine);
    return glm::normalize(cosine * normal + sine * (std::cos(azimuth) * tangent + std::sin(azimuth) * bitangent));
}

SpecularLobe white_lobe(float alpha, float cosine_o) {
    return {glm::vec3(1.0f), glm::vec3(1.0f), alpha, normal, direction_at(cosine_o)};
}

// Integral over half vectors of D times `factor(n.h, wo.h)`, wo at `cosine_o` in the plane of azimuth 0.
template <typename Factor>
double integrate_normals(double alpha, double cosine_o, const Factor& factor) {
    const double sine_o = std::sqrt(1.0 - cosine_o * cosine_o);
    const auto integrand = [&](double azimuth, double y) {
        // As in HalfVectorCells: the slope over alpha is tan(acos(1 - y)).
        const double q = 1.0 - y, t = alpha * std::sqrt(1.0 - q * q) / q, cosine_h = 1.0 / std::sqrt(1.0 + t * t);
        const double distribution = ggx_distribution(cosine_h, 1.0 - cosine_h * cosine_h, alpha);
        const double oh = cosine_h * (sine_o * t * std::cos(azimuth) + cosine_o);
        return distribution * factor(cosine_h, oh) * cosine_h * cosine_h * cosine_h * alpha * alpha / (q * q * q);
    };
    double sum = 0.0;
    for (int octant_index = 0; octant_index < 8; ++octant_index) {
        const double first = glm::quarter_pi<double>() * octant_index;
        sum += integrate_square(integrand, first, first + glm::quarter_pi<double>(), 0.0, 1.0, 1e-8, 12);
    }
    return sum;
}

// Heitz 2014, equation 4: the microfacets' projected area is that of the surface, from above and (what is visible) from
// wo. The second holds only if D and G1 belong together; it is the weak white furnace test: reflection without Fresnel
// and shadowing loses nothing.
TEST(SpecularLobe, ProjectedAreaOfVisibleMicrofacetsIsThatOfTheSurface) {
    for (const double alpha : {0.02, 0.2, 0.6, 1.0}) {
        EXPECT_NEAR(integrate_normals(alpha, 1.0, [](double nh, double) { return nh; }), 1.0, 1e-5) << alpha;
        for (const double cosine : {1.0, 0.6, 0.2, 0.05}) {
            // 2 / (c + root) is G1 / c.
            const double g1_over_cosine = 2.0 / (cosine + smith_root(cosine, alpha));
            const double visible =
                integrate_normals(alpha, cosine, [](double, double oh) { return std::max(0.0, oh); });
            // The quadrature stops where halving changes a part by less than 1e-4.
            EXPECT_NEAR(g1_over_cosine * visible, 1.0, 3e-4) << "alpha " << alpha << " cosine " << cosine;
        }
    }
}

TEST(SpecularLobe, IsReciprocal) {
    for (const float alpha : {0.01f, 0.2f, 1.0f}) {
        for (int i = 0; i < 200; ++i) {
            const glm::vec2 u = IndependentNumbers(1, 2 * i).u, v = IndependentNumbers(1, 2 * i + 1).u;
            const glm::vec3 wo = direction_at(0.01f + 0.98f * u.x, 6.0f * u.y);
            const glm::vec3 wi = direction_at(0.01f + 0.98f * v.x, 6.0f * v.y);
            const glm::vec3 f0(0.04f, 0.5f, 0.9f), f90(1.0f, 0.8f, 1.0f);
            const glm::vec3 there = SpecularLobe(f0, f90, alpha, normal, wo).evaluate(wi).reflected;
            const glm::vec3 back = SpecularLobe(f0, f90, alpha, normal, wi).evaluate(wo).reflected;
            for (int c = 0; c < 3; ++c) {
                const float f = there[c] / glm::dot(normal, wi), g = back[c] / glm::dot(normal, wo);
                // Both take the same half vector; wo.h and wi.h differ by rounding, six times so in the fifth power.
                EXPECT_NEAR(f, g, 2e-5f * (f + g)) << alpha << " sample " << i << " channel " << c;
            }
        }
    }
}

// Torrance-Sparrow by the textbook: D, G1 and Lambda as Heitz writes them, in double precision.
TEST(SpecularLobe, EvaluatesTheTextbookFormula) {
    for (const double alpha : {0.05, 0.3, 1.0}) {
        for (int i = 0; i < 100; ++i) {
            const glm::vec2 u = IndependentNumbers(2, 2 * i).u, v = IndependentNumbers(2, 2 * i + 1).u;
            const glm::vec3 wo = direction_at(0.05f + 0.94f * u.x, 6.0f * u.y);
            const glm::vec3 wi = direction_at(0.05f + 0.94f * v.x, 6.0f * v.y);
            const glm::dvec3 n(normal), o(wo), in(wi), h = glm::normalize(o + in);
            const double nh = glm::dot(n, h), tan2 = 1.0 / (nh * nh) - 1.0, a2 = alpha * alpha;
            const double distribution = 1.0 / (glm::pi<double>() * a2 * std::pow(nh, 4) * std::pow(1.0 + tan2 / a2, 2));
            const auto lambda = [&](double c) { return 0.5 * (std::sqrt(1.0 + a2 * (1.0 / (c * c) - 1.0)) - 1.0); };
            const double co = glm::dot(n, o), ci = glm::dot(n, in);
            const double masking = 1.0 / (1.0 + lambda(co) + lambda(ci));
            const double fresnel = 0.1 + 0.9 * std::pow(1.0 - glm::dot(o, h), 5);
            const SpecularLobe lobe(glm::vec3(0.1f), glm::vec3(1.0f), static_cast<float>(alpha), normal, wo);
            const SpecularLobeValue value = lobe.evaluate(wi);
            const double expected = fresnel * distribution * masking / (4.0 * co);
            const double density = distribution / (1.0 + lambda(co)) / (4.0 * co);
            // Rounding of unit vectors (1e-7) over alpha 0.05, four times in D.
            EXPECT_NEAR(value.reflected.x, expected, 3e-5 * expected) << alpha << " sample " << i;
            EXPECT_NEAR(value.density, density, 3e-5 * density) << alpha << " sample " << i;
        }
    }
}

// What the samples weigh on average is the directional albedo: by quadrature, and by the table within its bound.
TEST(SpecularLobe, MeanWeightIsTheDirectionalAlbedo) {
    const SpecularAlbedo table;
    constexpr int samples = 200000;
    const glm::vec3 f0(1.0f, 0.04f, 0.0f), f90(1.0f);
    for (const float alpha : {smallest_ggx_alpha, 0.03f, 0.2f, 0.5f, 1.0f}) {
        for (const float cosine : {1.0f, 0.6f, 0.2f, 0.03f, 0.003f}) {
            const SpecularLobe lobe(f0, f90, alpha, normal, direction_at(cosine));
            glm::dvec3 sum(0.0), squares(0.0);
            for (int i = 0; i < samples; ++i) {
                const glm::dvec3 weight(lobe.sample(IndependentNumbers(3, i).u).weight);
                // 1 + 1e-6: G2 <= G1, to rounding.
                ASSERT_TRUE(weight.x >= 0.0 && weight.x <= 1.000001) << weight.x << " alpha " << alpha;
                sum += weight, squares += weight * weight;
            }
            const glm::dvec2 split = integrate_specular_albedo(lobe.cosine_o(), alpha, 64);
            const glm::vec3 tabulated = table.albedo(f0, f90, lobe.cosine_o(), alpha);
            for (int c = 0; c < 3; ++c) {
                const double mean = sum[c] / samples, expected = f0[c] * split.x + f90[c] * split.y;
                const double deviation = std::sqrt(std::max(0.0, squares[c] / samples - mean * mean) / samples);
                // 4.5 deviations: by chance once in 2000 runs of these 75; 5e-5 of the quadrature.
                EXPECT_NEAR(mean, expected, 4.5 * deviation + 5e-5) << alpha << " " << cosine << " channel " << c;
                EXPECT_LT(4.5 * deviation, 0.01) << "1 % would not be seen: " << alpha << " " << cosine;
                EXPECT_NEAR(tabulated[c], mean, 4.5 * deviation + SpecularAlbedo::error_bound)
                    << alpha << " " << cosine << " channel " << c;
            }
        }
    }
}

TEST(SpecularAlbedo, TableIsWithinItsBoundOfTheIntegral) {
    const SpecularAlbedo table;
    double worst = 0.0;
    for (int j = 0; j <= 40; ++j) {
        const float alpha = ggx_alpha(std::sqrt(smallest_ggx_alpha) * 1.0001f + 0.024205f * static_cast<float>(j));
        for (int i = 0; i <= 60; ++i) {
            const float x = static_cast<float>(i) / 60.0f, cosine = x * x * x;  // many near the horizon
            const glm::vec2 read = table.split(cosine, alpha);
            const glm::dvec2 exact = integrate_specular_albedo(cosine, alpha, 40);
            for (const double error :
                 {read.x - exact.x, read.y - exact.y, static_cast<double>(read.x) + read.y - exact.x - exact.y}) {
                worst = std::max(worst, std::abs(error));
                EXPECT_LT(std::abs(error), SpecularAlbedo::error_bound) << "alpha " << alpha << " cosine " << cosine;
            }
        }
    }
    EXPECT_GT(worst, 0.25 * SpecularAlbedo::error_bound) << "the bound is much too wide";
}

// The quadrature that the table is checked with converges: doubled, it stays.
TEST(SpecularAlbedo, QuadratureConverges) {
    for (const double alpha : {0.001, 0.01, 0.1, 0.5, 1.0}) {
        for (const double cosine : {1.0, 0.5, 0.1, 0.01, 0.001}) {
            const glm::dvec2 coarse = integrate_specular_albedo(cosine, alpha, 40);
            const glm::dvec2 fine = integrate_specular_albedo(cosine, alpha, 160);
            EXPECT_NEAR(coarse.x, fine.x, 8e-4) << alpha << " " << cosine;  // a fifth of the table's bound
            EXPECT_NEAR(coarse.y, fine.y, 8e-4) << alpha << " " << cosine;
        }
    }
    // Closed form: seen from the normal, at alpha = 1, A + B is 1 - ln 2 (D = 1 / pi, G2 / (4 c) = 1 / (2 (1 + c_i))).
    const glm::dvec2 split = integrate_specular_albedo(1.0, 1.0, 64);
    EXPECT_NEAR(split.x + split.y, 1.0 - std::log(2.0), 1e-9);
}

// With any albedo up to 1 the diffuse lobe, scaled by 1 - E, and the specular one stay below 1 together.
TEST(SpecularAlbedo, NeverReflectsMoreThanArrives) {
    const SpecularAlbedo table;
    for (const glm::vec2 split : table.table()) {
        EXPECT_TRUE(split.x >= 0.0f && split.y >= 0.0f);
        EXPECT_LE(split.x + split.y, 1.000001f);  // rounding of the sum
    }
    for (const float alpha : {0.0f, smallest_ggx_alpha, 0.02f, 0.3f, 0.77f, 1.0f}) {
        for (float cosine = 0.0f; cosine <= 1.0f; cosine += 0.0123f) {
            const glm::vec3 f0(0.04f, 0.9f, 1.0f), specular = table.albedo(f0, glm::vec3(1.0f), cosine, alpha);
            for (int c = 0; c < 3; ++c) {
                EXPECT_LE(specular[c], 1.000001f) << alpha << " " << cosine;
                const glm::dvec2 exact = alpha > 0.0f ? integrate_specular_albedo(cosine, alpha, 24)
                                                      : glm::dvec2(table.split(cosine, alpha));
                const double total = f0[c] * exact.x + exact.y + (1.0 - specular[c]);
                EXPECT_LE(total, 1.0 + SpecularAlbedo::error_bound) << alpha << " " << cosine;
            }
        }
    }
}

// Away from grazing angles the narrowest lobe reflects what the mirror does: E keeps its value at the limit.
TEST(SpecularAlbedo, MirrorContinuesTheNarrowestLobe) {
    const SpecularAlbedo table;
    for (const float cosine : {1.0f, 0.7f, 0.4f, 0.2f}) {
        const glm::vec2 narrow = table.split(cosine, smallest_ggx_alpha), mirror = table.split(cosine, 0.0f);
        EXPECT_NEAR(narrow.x, mirror.x, SpecularAlbedo::error_bound) << cosine;
        EXPECT_NEAR(narrow.y, mirror.y, SpecularAlbedo::error_bound) << cosine;
        EXPECT_FLOAT_EQ(mirror.y, std::pow(1.0f - cosine, 5.0f));
    }
}

TEST(SpecularLobe, BelowItsLimitIsAMirror) {
    EXPECT_EQ(ggx_alpha(0.0f), 0.0f);
    EXPECT_EQ(ggx_alpha(0.0316f), 0.0f);  // 0.0316^2 = 0.000999
    EXPECT_FLOAT_EQ(ggx_alpha(0.5f), 0.25f);
    const glm::vec3 wo = direction_at(0.4f), f0(0.1f, 0.2f, 0.3f);
    const SpecularLobe mirror(f0, glm::vec3(1.0f), 0.0f, normal, wo);
    ASSERT_TRUE(mirror.is_mirror());
    const SpecularLobeSample sample = mirror.sample({0.3f, 0.9f});
    EXPECT_NEAR(glm::length(sample.direction - (2.0f * glm::dot(normal, wo) * normal - wo)), 0.0f, 1e-6f);
    EXPECT_EQ(sample.density, 0.0f);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sample.weight[c], f0[c] + (1.0f - f0[c]) * std::pow(0.6f, 5.0f), 1e-6f);
    EXPECT_EQ(mirror.evaluate(sample.direction).reflected, glm::vec3(0.0f));
}

// Weight times density is what evaluate() tells of the same direction, at all angles, corners of the square included.
TEST(SpecularLobe, SamplesAgreeWithEvaluation) {
    constexpr float last = 1.0f - 0x1p-24f;
    for (const float alpha : {smallest_ggx_alpha, 0.05f, 0.4f, 1.0f}) {
        for (const float cosine : {1.0f, 0.5f, 0.1f, 0.01f}) {
            const SpecularLobe lobe = white_lobe(alpha, cosine);
            for (int i = 0; i < 2000; ++i) {
                glm::vec2 u = IndependentNumbers(4, i).u;
                if (i < 9) {
                    const int row = i / 3, column = i % 3;
                    u = 0.5f * last * glm::vec2(column, row);
                }
                const SpecularLobeSample sample = lobe.sample(u);
                if (sample.weight == glm::vec3(0.0f)) continue;
                const SpecularLobeValue value = lobe.evaluate(sample.direction);
                // wo + wi keeps an error of 1e-7 of a sum as short as twice the sine of their angle; over alpha that is
                // the relative error of the slope, and D has its fourth power.
                const float length = glm::length(sample.direction + direction_at(cosine));
                const float tolerance = 1e-5f + 4.0f * 2e-7f / (alpha * length);
                EXPECT_NEAR(value.density / sample.density, 1.0f, tolerance)
                    << alpha << " " << cosine << " sample " << i;
                // Near the horizon the cosine of wi has lost digits to the rounding of wi.
                const float of_cosine = 2e-7f / glm::dot(normal, sample.direction);
                EXPECT_NEAR(sample.weight.x * value.density / value.reflected.x, 1.0f, 1e-5f + tolerance + of_cosine)
                    << alpha << " " << cosine << " sample " << i;
            }
        }
    }
}

// An interpolated normal may lean away from the viewer. The lobe is then the one seen from the horizon: finite, dark
// nowhere, and continuous.
TEST(SpecularLobe, IsContinuousWhereTheViewerSinksBelowTheHorizon) {
    glm::vec3 tangent, bitangent;
    complete_basis(normal, tangent, bitangent);
    for (const float alpha : {0.0f, smallest_ggx_alpha, 0.3f, 1.0f}) {
        for (const float cosine : {1e-6f, 0.0f, -1e-6f, -0.3f, -0.99f}) {
            const glm::vec3 wo = glm::normalize(cosine * normal + std::sqrt(1.0f - cosine * cosine) * tangent);
            const SpecularLobe lobe(glm::vec3(0.5f), glm::vec3(1.0f), alpha, normal, wo);
            EXPECT_NEAR(lobe.cosine_o(), 0.0f, 2e-6f);
            double weight = 0.0;
            constexpr int samples = 4000;
            for (int i = 0; i < samples; ++i) {
                const SpecularLobeSample sample = lobe.sample(IndependentNumbers(6, i).u);
                ASSERT_TRUE(std::isfinite(sample.density) && sample.weight.x >= 0.0f && sample.weight.x <= 1.000001f);
                EXPECT_NEAR(glm::length(sample.direction), 1.0f, 1e-6f);
                weight += sample.weight.x;
            }
            // At the very horizon shadowing takes nothing (E(0) = A(0) / 2 + B(0)); 0.5 is the deviation at most.
            const double expected = alpha == 0.0f ? 1.0 : [&] {
                const glm::dvec2 split = integrate_specular_albedo(0.0, alpha, 64);
                return 0.5 * split.x + split.y;
            }();
            EXPECT_NEAR(weight / samples, expected, 4.5 * 0.25 / std::sqrt(samples)) << alpha << " " << cosine;
        }
    }
    // Straight past the surface, and from below: nothing, and nothing infinite.
    const SpecularLobe lobe = white_lobe(0.3f, 0.0f);
    EXPECT_EQ(lobe.evaluate(-direction_at(0.0f)).reflected, glm::vec3(0.0f));
    EXPECT_EQ(lobe.evaluate(-normal).density, 0.0f);
}

// A diffuse and a specular lobe together, as the path tracer draws from both: the density is the mixture's.
TEST(Scattering, DirectionsHaveTheMixedDensity) {
    const glm::vec3 wo = direction_at(0.3f);
    SpecularVertex vertex;
    vertex.surface.f0 = glm::vec3(0.3f), vertex.surface.f90 = glm::vec3(1.0f), vertex.surface.alpha = 0.15f;
    vertex.to_viewer = wo;
    const Scattering scattering(vertex, normal, glm::vec3(0.5f, 0.2f, 0.1f), glm::vec3(0.4f), glm::vec3(0.0f));
    const DirectionCells cells(normal, 12);
    const auto probabilities =
        cells.integrals([&](const glm::vec3& direction) { return scattering.evaluate(direction).density; });
    // Where the lobes overlap, cells do not tell which of them was drawn, and with what.
    constexpr double kept = 0.4;
    const auto cell = [&](const ScatterSample& sample) {
        return sample.weight == glm::vec3(0.0f) ? -1 : cells.cell(sample.direction);
    };
    expect_density("choice of the lobe", probabilities, Rejection::possible, [&](glm::vec2 u) {
        return cell(scattering.sample(u.x, {u.y, third_number(u)}));
    });
    expect_density(
        "direction", probabilities, Rejection::possible,
        [&](glm::vec2 u) { return cell(scattering.sample(third_number(u), u)); }, Uses::both, kept);
}

// What passes and what a mirror reflects have a direction of their own, and a probability instead of a density.
TEST(Scattering, PassesAndMirrorsWithTheirShares) {
    const glm::vec3 wo = direction_at(0.6f), albedo(0.5f, 0.2f, 0.1f), specular(0.1f, 0.3f, 0.2f);
    const glm::vec3 transmission(0.05f, 0.1f, 0.2f);
    for (const float alpha : {0.0f, 0.15f}) {
        SpecularVertex vertex;
        vertex.surface.f0 = glm::vec3(0.3f), vertex.surface.f90 = glm::vec3(1.0f), vertex.surface.alpha = alpha;
        vertex.to_viewer = wo;
        const Scattering scattering(vertex, normal, albedo, specular, transmission);
        // By the brightest channel of each: diffuse 0.5, specular 0.3, passing 0.2.
        constexpr double passing_share = 0.2, mirrored_share = 0.3;
        const DirectionCells cells(normal, 4);
        auto probabilities =
            cells.integrals([&](const glm::vec3& direction) { return scattering.evaluate(direction).density; });
        const int passed = static_cast<int>(probabilities.size()), mirrored = passed + 1;
        probabilities.push_back(passing_share);
        if (alpha == 0.0f) probabilities.push_back(mirrored_share);
        const auto cell = [&](const ScatterSample& sample) {
            if (sample.passes) return passed;
            if (sample.weight == glm::vec3(0.0f)) return -1;
            return sample.density > 0.0f ? cells.cell(sample.direction) : mirrored;
        };
        const std::string name = "panes of alpha " + std::to_string(alpha);
        const Rejection rejection = alpha == 0.0f ? Rejection::never : Rejection::possible;
        expect_density(
            name + ", choice of the lobe", probabilities, rejection,
            [&](glm::vec2 u) {
                return cell(scattering.sample(u.x, {u.y, third_number(u)}));
            },
            Uses::first, 0.6);
        const ScatterSample through = scattering.sample(0.1f, {0.3f, 0.7f});
        ASSERT_TRUE(through.passes);
        EXPECT_EQ(through.direction, -wo);
        EXPECT_EQ(through.density, 0.0f);
        // Divided by the probability, each to one rounding.
        for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(through.weight[c], transmission[c] / 0.2f);
        if (alpha > 0.0f) continue;  // the rest is that of DirectionsHaveTheMixedDensity
        // The numbers of the direction show only where the diffuse lobe was chosen.
        expect_density(
            name + ", direction", probabilities, rejection,
            [&](glm::vec2 u) { return cell(scattering.sample(third_number(u), u)); }, Uses::both, 0.35);
        const ScatterSample reflected = scattering.sample(0.4f, {0.3f, 0.7f});
        EXPECT_FALSE(reflected.passes);
        EXPECT_EQ(reflected.density, 0.0f);
        EXPECT_LT(glm::length(reflected.direction - (2.0f * 0.6f * normal - wo)), 1e-6f);
        const float fresnel = 0.3f + 0.7f * std::pow(0.4f, 5.0f);
        // 1e-6: the fifth power of a cosine that is off by a rounding.
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(reflected.weight[c], fresnel / 0.3f, 1e-6f);
    }
}

}  // namespace
}  // namespace plumb
