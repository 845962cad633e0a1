// Every sampling routine of the path tracer against its density, by the chi-square test of chi_square.h, which also
// plants a bias of 1 % and expects to see it.
#include "chi_square.h"

#include <gtest/gtest.h>

#include "direction_cells.h"
#include "pathtracer/direction_sampling.h"
#include "pathtracer/discrete_distribution.h"
#include "pathtracer/environment_distribution.h"
#include "pathtracer/light_table.h"
#include "pathtracer/microfacet.h"
#include "scenes/camera.h"
#include "test_scenes.h"

namespace plumb {
namespace {

// Closed forms and tables: Q(1/2, x) = erfc(sqrt x), Q(1, x) = exp(-x), and Abramowitz, Stegun 1964, table 26.8.
TEST(ChiSquare, PValueIsThatOfTablesAndClosedForms) {
    for (const double x : {0.01, 0.7, 1.4, 3.0, 20.0}) {
        EXPECT_NEAR(upper_gamma_share(0.5, x), std::erfc(std::sqrt(x)), 1e-14);
        EXPECT_NEAR(upper_gamma_share(1.0, x), std::exp(-x), 1e-14);
    }
    EXPECT_NEAR(chi_square_p_value(18.30704, 10), 0.05, 1e-7);   // seven digits are tabulated
    EXPECT_NEAR(chi_square_p_value(135.807, 100), 0.01, 1e-6);   // six
    EXPECT_NEAR(chi_square_p_value(149.449, 100), 0.001, 1e-7);  // six
}

TEST(ChiSquare, PoolsRareCellsAndRefusesWhatIsImpossible) {
    const std::vector<double> probabilities = {0.5, 0.48, 0.01, 0.01, 0.0};
    // 200 samples expect 2 in each of the rare cells: pooled with the next rarest.
    const ChiSquareResult pooled = chi_square(std::vector<double>{100, 96, 1, 3, 0}, probabilities);
    EXPECT_EQ(pooled.degrees_of_freedom, 1);
    EXPECT_NEAR(pooled.statistic, 0.0, 1e-12);
    EXPECT_EQ(chi_square(std::vector<double>{100, 96, 1, 2, 1}, probabilities).p_value, 0.0);
}

// If the numbers the tests are fed with were not uniform, the tests would speak of them.
TEST(ChiSquare, PassesUniformNumbers) {
    expect_density("the square itself", std::vector<double>(64, 1.0 / 64.0), Rejection::never,
                   [](glm::vec2 u) { return 8 * static_cast<int>(8.0f * u.y) + static_cast<int>(8.0f * u.x); });
}

// Cells of equal area: 8 rings by 8 octants.
int disc_cell(glm::vec2 point) {
    const double squared = static_cast<double>(point.x) * point.x + static_cast<double>(point.y) * point.y;
    return 8 * std::min(static_cast<int>(8.0 * squared), 7) + octant(point.x, point.y);
}

TEST(ChiSquare, DiscIsUniform) {
    expect_density("disc", std::vector<double>(64, 1.0 / 64.0), Rejection::never,
                   [](glm::vec2 u) { return disc_cell(sample_disc(u)); });
}

// The points of the lens through which one pixel is seen, found again from the rays alone.
TEST(ChiSquare, LensIsUniform) {
    Camera camera = Camera::look_at("test", {1, 2, 3}, {4, 1, 0}, 0.7f);
    camera.aperture_radius = 0.25f, camera.focus_distance = 2.5f;
    const View view(camera, 64, 48);
    const glm::vec3 right(camera.world_from_camera[0]), up(camera.world_from_camera[1]);
    expect_density("lens", std::vector<double>(64, 1.0 / 64.0), Rejection::never, [&](glm::vec2 u) {
        const glm::vec3 offset = view.lens_ray(11.5f, 40.25f, sample_disc(u)).origin - camera.position();
        return disc_cell({glm::dot(offset, right) / 0.25f, glm::dot(offset, up) / 0.25f});
    });
}

TEST(ChiSquare, TriangleIsUniform) {
    // With s = x + y: s^2 and y / s are uniform over a triangle.
    expect_density("triangle", std::vector<double>(64, 1.0 / 64.0), Rejection::never, [](glm::vec2 u) {
        const glm::vec2 at = sample_triangle(u);
        const float s = at.x + at.y;
        if (!(at.x >= 0.0f && at.y >= 0.0f && s <= 1.0f)) return -1;
        return 8 * std::min(static_cast<int>(8.0f * s * s), 7) +
               std::min(static_cast<int>(s > 0.0f ? 8.0f * at.y / s : 0.0f), 7);
    });
}

TEST(ChiSquare, CosineHemisphereHasItsDensity) {
    for (const glm::vec3 axis : {glm::vec3(0, 0, -1), glm::vec3(1, -2, -3)}) {
        const glm::vec3 normal = glm::normalize(axis);
        const DirectionCells cells(normal, 12);
        expect_density("cosine hemisphere", cells.integrals([&](const glm::vec3& direction) {
            return std::max(0.0f, glm::dot(direction, normal)) * glm::one_over_pi<float>();
        }),
                       Rejection::never, [&](glm::vec2 u) { return cells.cell(sample_cosine_hemisphere(normal, u)); });
    }
}

// From the sun (0.00465 rad) to a hemisphere.
TEST(ChiSquare, ConeIsUniform) {
    const glm::vec3 axis = glm::normalize(glm::vec3(-2, 3, 1));
    glm::vec3 tangent, bitangent;
    complete_basis(axis, tangent, bitangent);
    for (const float angle : {0.00465f, 1.5707963f}) {
        const float height = cap_height(angle);
        // Rings of equal solid angle; their density times their solid angle.
        const double solid_angle = glm::two_pi<double>() * (2.0 * std::pow(std::sin(0.5 * angle), 2.0));
        expect_density("cone of " + std::to_string(angle),
                       std::vector<double>(64, cone_density(height) * solid_angle / 64.0), Rejection::never,
                       [&](glm::vec2 u) {
                           const glm::vec3 direction = sample_cone(axis, height, u);
                           const glm::vec2 across(glm::dot(direction, tangent), glm::dot(direction, bitangent));
                           // sin^2 = 2 h - h^2 for a cap of height h, which does not cancel for small cones.
                           const float squared = glm::dot(across, across);
                           const float below = squared / (1.0f + std::sqrt(std::max(0.0f, 1.0f - squared)));
                           return disc_cell(glm::normalize(across) * std::sqrt(below / height));
                       });
    }
}

TEST(ChiSquare, DiscreteDistributionChoosesByWeight) {
    std::vector<double> weights;
    weights.reserve(50);
    for (int i = 0; i < 50; ++i) weights.push_back(i % 7 == 3 ? 0.0 : 0.2 + (i * 37 % 11) * (i % 5 == 0 ? 4.0 : 1.0));
    const DiscreteDistribution distribution(weights);
    std::vector<double> probabilities(50);
    for (std::size_t i = 0; i < 50; ++i) probabilities[i] = distribution.probability(i);
    expect_density(
        "discrete", probabilities, Rejection::never,
        [&](glm::vec2 u) { return static_cast<int>(distribution.sample(u.x)); }, Uses::first);
    // The place within the chosen item's share is uniform and knows nothing of the item.
    const DiscreteDistribution two(std::vector<double>{1.0, 3.0});
    std::vector<double> within_probabilities(32, 0.25 / 16);
    std::fill(within_probabilities.begin() + 16, within_probabilities.end(), 0.75 / 16);
    expect_density(
        "within", within_probabilities, Rejection::never,
        [&](glm::vec2 u) {
            const std::size_t item = two.sample(u.x);
            return static_cast<int>(16 * item) + static_cast<int>(16.0 * two.within(u.x, item));
        },
        Uses::first);
}

TEST(ChiSquare, EnvironmentImageHasItsDensity) {
    const Scene scene = sky_scene();
    const EnvironmentDistribution distribution(scene);
    // Cells are texels, from the directions' own angles: u = 0.5 towards -Z, the turn about +Y, v = 0 straight up.
    constexpr int columns = 16, rows = 8;
    const auto direction_at = [](double u, double v) {
        const double longitude = glm::two_pi<double>() * (u - 0.5) - 1.3, theta = glm::pi<double>() * v;
        return glm::vec3(std::sin(longitude) * std::sin(theta), std::cos(theta),
                         -std::cos(longitude) * std::sin(theta));
    };
    std::vector<double> probabilities;
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const auto integrand = [&](double u, double v) {
                const double solid_angle = glm::two_pi<double>() * glm::pi<double>() * std::sin(glm::pi<double>() * v);
                return distribution.density(direction_at(u, v)) * solid_angle;
            };
            probabilities.push_back(
                integrate_square(integrand, static_cast<double>(i) / columns, static_cast<double>(i + 1) / columns,
                                 static_cast<double>(j) / rows, static_cast<double>(j + 1) / rows, 1e-6));
        }
    }
    expect_density("environment", probabilities, Rejection::never, [&](glm::vec2 u) {
        const glm::vec3 direction = distribution.sample(u).direction;
        double turn = 0.5 + (std::atan2(direction.x, -direction.z) + 1.3) / glm::two_pi<double>();
        turn -= std::floor(turn);
        // Samples within float rounding of a texel's border may be sorted wrongly: 1 in 10^6, well below the deviation.
        const double v = std::acos(glm::clamp(direction.y, -1.0f, 1.0f)) / glm::pi<double>();
        return columns * std::min(static_cast<int>(rows * v), rows - 1) +
               std::min(static_cast<int>(columns * turn), columns - 1);
    });
}

struct LobeCase {
    float alpha, cosine;
};

std::string name_of(const LobeCase& lobe) {
    return "lobe of alpha " + std::to_string(lobe.alpha) + " seen at cosine " + std::to_string(lobe.cosine);
}

void expect_lobe_density(const LobeCase& c) {
    const glm::vec3 normal = glm::normalize(glm::vec3(1, 2, -3));
    glm::vec3 tangent, bitangent;
    complete_basis(normal, tangent, bitangent);
    const glm::vec3 aside = glm::normalize(0.8f * tangent + 0.6f * bitangent);
    const glm::vec3 wo = c.cosine * normal + std::sqrt(1.0f - c.cosine * c.cosine) * aside;
    const SpecularLobe lobe(glm::vec3(0.04f), glm::vec3(1.0f), c.alpha, normal, wo);
    const HalfVectorCells cells(normal, aside, wo, c.alpha, 6);
    // Up to two thirds of the samples of the roughest lobes go below the horizon, and tell nothing of where.
    const double kept = c.alpha > 0.5f ? 0.5 : 0.7;
    expect_density(
        name_of(c), cells.integrals([&](const glm::vec3& wi) { return lobe.evaluate(wi).density; }),
        Rejection::possible,
        [&](glm::vec2 u) {
            const SpecularLobeSample sample = lobe.sample(u);
            return sample.weight.x > 0.0f ? cells.cell(sample.direction) : -1;
        },
        Uses::both, kept);
}

// Five angles for each roughness, from the normal to grazing.
TEST(ChiSquare, RoughLobesHaveTheirDensity) {
    for (const float alpha : {1.0f, 0.3f}) {
        for (const float cosine : {1.0f, 0.7f, 0.3f, 0.03f, 0.005f}) expect_lobe_density({alpha, cosine});
    }
}

TEST(ChiSquare, GlossyLobesHaveTheirDensity) {
    for (const float cosine : {1.0f, 0.7f, 0.3f, 0.05f, 0.005f}) expect_lobe_density({0.05f, cosine});
}

// The narrowest lobe stops at 84 degrees: beyond, the rounding of wo and wi themselves turns the half vector by more
// than a thousandth of the lobe's width, which as many samples would see.
TEST(ChiSquare, NarrowLobesHaveTheirDensity) {
    for (const float cosine : {1.0f, 0.8f, 0.5f, 0.2f, 0.1f}) expect_lobe_density({smallest_ggx_alpha, cosine});
}

}  // namespace
}  // namespace plumb
