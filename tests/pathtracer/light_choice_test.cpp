// The choice among lights and of points on them, and the densities per solid angle that the samples carry.
#include <numeric>

#include <gtest/gtest.h>

#include "chi_square.h"
#include "direction_cells.h"
#include "pathtracer/light_table.h"
#include "pathtracer/luminance.h"
#include "test_scenes.h"

namespace plumb {
namespace {

struct Triangle {
    glm::dvec3 a, b, c;
    double power;  // relative

    double area() const { return 0.5 * glm::length(glm::cross(b - a, c - a)); }

    // Where a ray from the origin meets the plane (Moller, Trumbore 1997): barycentric weights of b and c, distance.
    glm::dvec3 meet(const glm::dvec3& direction) const {
        const glm::dvec3 e1 = b - a, e2 = c - a, p = glm::cross(direction, e2), q = glm::cross(-a, e1);
        return glm::dvec3(glm::dot(-a, p), glm::dot(direction, q), glm::dot(e2, q)) / glm::dot(e1, p);
    }
    // Whether it meets the triangle, or would if that reached a little further.
    static bool is_met(const glm::dvec3& at, double margin = 0.0) {
        return at.x >= -margin && at.y >= -margin && at.x + at.y <= 1.0 + margin && at.z > 0.0;
    }

    // Density per solid angle of points that are uniform over the triangle: d^2 / (area |cosine|), and 0 beside it.
    double density(const glm::dvec3& direction) const {
        const glm::dvec3 at = meet(direction), normal = glm::normalize(glm::cross(b - a, c - a));
        return is_met(at) ? at.z * at.z / (area() * std::abs(glm::dot(normal, direction))) : 0.0;
    }
};

// Three lamps around the origin, none before another, each a quad of two triangles; and a wide sun.
struct Lamps {
    Scene scene;
    std::vector<Triangle> triangles;
    static constexpr float sun_radius = 0.2f;
    double sun_power = 0.0;

    Lamps() {
        add({{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}}, {1, 1, 1}, false);      // above, facing down
        add({{2, 0, -2}, {2, 1, -2}, {2, 1, 0}, {2, 0, 0}}, {4, 1, 2}, true);         // right
        add({{-3, -1, 0}, {-3, 1, 1}, {-2, 1, 2}, {-2, -1, 1}}, {0.5f, 2, 1}, true);  // left, skew
        DirectionalLight sun;
        sun.direction = glm::normalize(glm::vec3(1, -3, 6));
        sun.irradiance = glm::vec3(0.4f), sun.angular_radius = sun_radius;
        scene.directional_lights.push_back(sun);
        const double radius = 0.5 * scene.bounds().diagonal();
        sun_power = luminance(sun.irradiance) * glm::pi<double>() * radius * radius;
    }

    void add(const std::vector<glm::vec3>& quad, const glm::vec3& emission, bool two_sided) {
        add_quads(scene, add_material(scene, glm::vec3(0.5f), emission, two_sided), {quad});
        for (const auto& [second, third] : {std::pair(1, 2), std::pair(2, 3)}) {
            Triangle triangle{quad[0], quad[second], quad[third], 0.0};
            triangle.power = glm::pi<double>() * triangle.area() * luminance(emission) * (two_sided ? 2.0 : 1.0);
            triangles.push_back(triangle);
        }
    }

    double power() const {
        double sum = sun_power;
        for (const Triangle& triangle : triangles) sum += triangle.power;
        return sum;
    }

    double density(const glm::dvec3& direction) const {
        double sum = 0.0;
        for (const Triangle& triangle : triangles) sum += triangle.power * triangle.density(direction);
        const double cosine = -glm::dot(direction, glm::dvec3(scene.directional_lights[0].direction));
        if (cosine >= std::cos(sun_radius)) {
            sum += sun_power / (glm::two_pi<double>() * (1.0 - std::cos(static_cast<double>(sun_radius))));
        }
        return sum / power();
    }
};

constexpr glm::vec3 up(0.0f, 1.0f, 0.0f);
constexpr LightReceiver receiver{glm::vec3(0.0f), up, up, up};

// Cells: each triangle in eight parts of equal area, and the sun's disc in eight.
int lamp_cell(const Lamps& lamps, const glm::vec3& direction) {
    // Rounding puts a few points of an edge beside it; the lamps lie further apart than this.
    constexpr double margin = 1e-5;
    for (std::size_t i = 0; i < lamps.triangles.size(); ++i) {
        const glm::dvec3 at = lamps.triangles[i].meet(direction);
        if (!Triangle::is_met(at, margin)) continue;
        // With s = x + y: s^2 and y / s are uniform over a triangle.
        const double s = at.x + at.y;
        const int band = std::clamp(static_cast<int>(2.0 * s * s), 0, 1);
        return 8 * static_cast<int>(i) + 4 * band + std::clamp(static_cast<int>(4.0 * at.y / s), 0, 3);
    }
    glm::vec3 tangent, bitangent;
    complete_basis(-lamps.scene.directional_lights[0].direction, tangent, bitangent);
    return 48 + octant(glm::dot(direction, tangent), glm::dot(direction, bitangent));
}

TEST(LightChoice, PointsAreChosenByPowerAndUniformlyByArea) {
    const Lamps lamps;
    const TracedScene traced(lamps.scene);
    const EnvironmentDistribution none(lamps.scene);
    const LightTable lights(traced, none, EmitterSampling::both);
    std::vector<double> probabilities;
    for (const Triangle& triangle : lamps.triangles) probabilities.resize(probabilities.size() + 8, triangle.power);
    probabilities.resize(probabilities.size() + 8, lamps.sun_power);
    for (double& probability : probabilities) probability /= 8.0 * lamps.power();
    // Half of what tilts the places on one lamp is averaged within its eight cells.
    constexpr double kept = 0.5;
    const auto cell = [&](float x, float y) {
        return lamp_cell(lamps, lights.sample_extended(receiver, x, y).direction);
    };
    expect_density(
        "choice of the lamp and first number of the point", probabilities, Rejection::never,
        [&](glm::vec2 u) { return cell(u.x, u.y); }, Uses::both, kept);
}

TEST(LightChoice, SamplesCarryTheirDensity) {
    const Lamps lamps;
    const TracedScene traced(lamps.scene);
    const EnvironmentDistribution none(lamps.scene);
    const LightTable lights(traced, none, EmitterSampling::both);
    int at_edges = 0;
    for (int i = 0; i < 20000; ++i) {
        const glm::vec2 u = IndependentNumbers(5, i).u;
        const LightSample sample = lights.sample_extended(receiver, u.x, u.y);
        const double expected = lamps.density(sample.direction);
        // Directions within rounding of an edge may be found on neither side of it, or on both.
        const double error = std::abs(sample.density - expected) / sample.density;
        if (error > 0.4) {
            ++at_edges;
        } else {
            // The chain of float operations: distance squared, cosine, area, probability.
            EXPECT_LT(error, 1e-5) << "sample " << i << ": " << sample.density << " for " << expected;
        }
    }
    EXPECT_LE(at_edges, 2);  // 1e-6 of an area lies that near to an edge
}

// The sky's samples are those of its texels by their light, each evenly spread in texture coordinates.
TEST(LightChoice, SamplesOfASkyCarryTheirDensity) {
    Scene scene = sky_scene();
    add_quads(scene, add_material(scene, glm::vec3(0.5f), glm::vec3(2.0f)), {floor_quad(0.5f, 2.0f)});
    const TracedScene traced(scene);
    const EnvironmentDistribution environment(scene);
    const LightTable lights(traced, environment, EmitterSampling::both);
    const Texture& sky = scene.textures[0];
    constexpr double pi = glm::pi<double>();
    // Luminance times solid angle. Between the centres of texels the sky is bilinear, for which the midpoint rule is
    // exact where no step spans a centre.
    std::vector<double> texels;
    for (int i = 0; i < sky.width * sky.height; ++i) {
        const int row = i / sky.width, column = i % sky.width;
        constexpr int steps = 8;
        double sum = 0.0;
        for (int j = 0; j < steps * steps; ++j) {
            const int y = j / steps, x = j % steps;
            const glm::dvec2 uv((column + (x + 0.5) / steps) / sky.width, (row + (y + 0.5) / steps) / sky.height);
            sum += luminance(scene.environment.radiance * glm::vec3(sky.sample(glm::vec2(uv)))) / (steps * steps);
        }
        const double top = std::cos(pi * row / sky.height), bottom = std::cos(pi * (row + 1) / sky.height);
        texels.push_back(sum * (top - bottom) * 2.0 * pi / sky.width);
    }
    const double total = std::accumulate(texels.begin(), texels.end(), 0.0);
    int of_the_sky = 0, at_edges = 0;
    constexpr int samples = 20000;
    for (int i = 0; i < samples; ++i) {
        const glm::vec2 u = IndependentNumbers(5, i).u;
        const LightSample sample = lights.sample_extended(receiver, u.x, u.y);
        if (sample.farthest == 1.0f) continue;
        ++of_the_sky;
        double turn = 0.5 + (std::atan2(sample.direction.x, -sample.direction.z) + 1.3) / (2.0 * pi);
        turn -= std::floor(turn);
        const double theta = std::atan2(std::hypot(sample.direction.x, sample.direction.z), sample.direction.y);
        const int column = std::min(static_cast<int>(turn * sky.width), sky.width - 1);
        const int row = std::min(static_cast<int>(theta / pi * sky.height), sky.height - 1);
        const int texel = row * sky.width + column;
        const double probability = 0.5 * texels[static_cast<std::size_t>(texel)] / total;
        const double expected = probability * sky.width * sky.height / (2.0 * pi * pi * std::sin(theta));
        // Directions within rounding of a texel's edge may be found on its other side.
        const double error = std::abs(sample.density - expected) / sample.density;
        if (error > 0.01) {
            ++at_edges;
        } else {
            // Roundings of float32; near a pole those of the direction weigh more.
            EXPECT_LT(error, 1e-5 + 1e-7 / std::sin(theta)) << "sample " << i << ": " << sample.density;
        }
    }
    EXPECT_NEAR(of_the_sky, 0.5 * samples, 4.5 * std::sqrt(samples) / 2.0);
    EXPECT_LE(at_edges, 2);  // 1e-6 of an area lies that near to an edge
}

// Half of the samples go to an environment image, the rest to the lamps by power.
TEST(LightChoice, SharesWithAnEnvironmentImage) {
    Lamps lamps;
    Texture sky;
    sky.width = 4, sky.height = 2, sky.wrap_v = TextureWrap::clamp;
    for (int i = 0; i < 8; ++i) sky.texels.insert(sky.texels.end(), {half(1.0f), half(2.0f), half(0.5f), half(1.0f)});
    lamps.scene.textures.push_back(sky);
    lamps.scene.environment = {glm::vec3(1.0f), 0, 0.0f};
    const TracedScene traced(lamps.scene);
    const EnvironmentDistribution environment(lamps.scene);
    const LightTable lights(traced, environment, EmitterSampling::both);
    // Cells: the six triangles, whose shadow rays end; all else. The sun's directions lie within the sky's.
    std::vector<double> probabilities;
    for (const Triangle& triangle : lamps.triangles) probabilities.push_back(0.5 * triangle.power / lamps.power());
    probabilities.push_back(0.5 * lamps.sun_power / lamps.power() + 0.5);
    expect_density(
        "lamps and sky", probabilities, Rejection::never,
        [&](glm::vec2 u) {
            const LightSample sample = lights.sample_extended(receiver, u.x, u.y);
            if (sample.farthest != 1.0f) return 6;
            return lamp_cell(lamps, sample.direction) / 8;
        },
        Uses::first);
}

// A constant sky has no texels to choose: its directions are those of the cosine, half of them where it shares with the
// lamps, and so is the density that they carry.
TEST(LightChoice, OfAConstantSkyFollowsTheCosine) {
    for (const bool with_lamps : {false, true}) {
        Lamps lamps;
        Scene scene = with_lamps ? lamps.scene : Scene();
        scene.environment.radiance = glm::vec3(1.0f, 2.0f, 0.5f);
        const TracedScene traced(scene);
        const EnvironmentDistribution environment(scene);
        const LightTable lights(traced, environment, EmitterSampling::lights);
        const double share = with_lamps ? 0.5 : 1.0;
        const glm::vec3 normal = glm::normalize(glm::vec3(1, 3, -2));
        const LightReceiver tilted{glm::vec3(0.0f), normal, normal, normal};
        const DirectionCells cells(normal, 12);
        const auto of_the_sky = [&](const LightSample& sample) {
            // The sun's and the sky's rays never end; their colours differ.
            return sample.farthest != 1.0f && sample.radiance.x > 0.0f && sample.radiance.y == 2.0f * sample.radiance.x;
        };
        const auto density = [&](const glm::vec3& direction) {
            return share * std::max(0.0f, glm::dot(direction, normal)) * glm::one_over_pi<float>();
        };
        int wrong = 0;
        expect_density(
            with_lamps ? "constant sky beside lamps" : "constant sky", cells.integrals(density),
            with_lamps ? Rejection::possible : Rejection::never,
            [&](glm::vec2 u) {
                const LightSample sample = lights.sample_extended(tilted, u.x, u.y);
                if (!of_the_sky(sample)) return -1;
                // 1e-5: the rounding of a cosine near the horizon, against one that is not small.
                wrong += std::abs(sample.density - density(sample.direction)) < 1e-5 ? 0 : 1;
                return cells.cell(sample.direction);
            },
            Uses::both, with_lamps ? 0.3 : 0.7);
        EXPECT_EQ(wrong, 0) << "densities that are not the cosine's";
    }
}

// Points and spots in five directions, besides one below the horizon and one that faces away, with a parallel light.
// What each sends to the receiver at the origin by the formulas of scenes/lights.h, in double.
struct Arriving {
    glm::dvec3 direction, radiance;  // irradiance on a surface that faces it
    double weight() const { return luminance(glm::vec3(radiance)) * std::max(0.0, direction.y); }
};
struct LampsWithoutExtent {
    Scene scene;
    std::vector<Arriving> arriving;

    LampsWithoutExtent() {
        point({{1, 2, 0}, {12, 6, 18}, {0.5f, 0.2f, 1.0f}});
        point({{-1, 1, 1}, {22, 22, 11}});
        point({{0, -1, 0}, glm::vec3(50.0f)});
        spot({0, 1.5f, -2}, {0.1f, -1.5f, 2.1f}, glm::vec3(9, 8, 7));
        spot({2, 1, 2}, {1, 0, 0}, glm::vec3(40.0f));
        spot({-2, 1.5f, -1}, {2.1f, -1.4f, 1}, glm::vec3(18, 20, 5));
        const glm::vec3 sun = glm::normalize(glm::vec3(-2, -1, 1)), irradiance(1, 2, 3);
        scene.directional_lights.push_back({"sun", sun, irradiance});
        arriving.push_back({-sun, irradiance});
    }

    struct Point {
        glm::vec3 position, intensity;
        Attenuation attenuation = {};
    };
    void point(const Point& lamp) {
        scene.point_lights.push_back({"point", lamp.position, lamp.intensity, lamp.attenuation});
        const double d = glm::length(glm::dvec3(lamp.position));
        const Attenuation& a = lamp.attenuation;
        arriving.push_back({glm::dvec3(lamp.position) / d,
                            glm::dvec3(lamp.intensity) / (a.constant + a.linear * d + a.quadratic * d * d)});
    }
    void spot(const glm::vec3& position, const glm::vec3& towards, const glm::vec3& intensity) {
        constexpr float inner = 0.02f, outer = 0.3f;
        const glm::vec3 axis = glm::normalize(towards);
        scene.spot_lights.push_back({"spot", position, axis, intensity, inner, outer});
        const double d = glm::length(glm::dvec3(position)), from = std::cos(inner), to = std::cos(outer);
        const glm::dvec3 direction = glm::dvec3(position) / d;
        const double t = std::clamp((-glm::dot(direction, glm::dvec3(axis)) - to) / (from - to), 0.0, 1.0);
        arriving.push_back({direction, glm::dvec3(intensity) * (t * t / (d * d))});
    }

    double sum() const {
        double sum = 0.0;
        for (const Arriving& light : arriving) sum += light.weight();
        return sum;
    }
    // Whose direction that is.
    int find(const glm::vec3& direction) const {
        int nearest = 0;
        for (std::size_t i = 1; i < arriving.size(); ++i) {
            const double cosine = glm::dot(arriving[i].direction, glm::dvec3(direction));
            if (cosine > glm::dot(arriving[static_cast<std::size_t>(nearest)].direction, glm::dvec3(direction))) {
                nearest = static_cast<int>(i);
            }
        }
        return nearest;
    }
};

TEST(LightsWithoutExtent, AreChosenByWhatTheyBring) {
    const LampsWithoutExtent lamps;
    const TracedScene traced(lamps.scene);
    const EnvironmentDistribution none(lamps.scene);
    const LightTable lights(traced, none, EmitterSampling::both);
    std::vector<double> probabilities;
    int lit = 0;
    for (const Arriving& light : lamps.arriving) {
        probabilities.push_back(light.weight() / lamps.sum());
        lit += probabilities.back() > 0.05 ? 1 : 0;
    }
    ASSERT_EQ(lit, 5);
    // What falls to a later lamp is taken from all over the interval, which averages half of the tilt away.
    expect_density(
        "lights without extent", probabilities, Rejection::never,
        [&](glm::vec2 u) { return lamps.find(lights.sample_without_extent(receiver, u.x).direction); }, Uses::first,
        0.4);
}

// The sample is the light's own radiance over the probability of its choice, so that the mean is the sum of all.
TEST(LightsWithoutExtent, CountForAllWhereOneIsChosen) {
    const LampsWithoutExtent lamps;
    const TracedScene traced(lamps.scene);
    const EnvironmentDistribution none(lamps.scene);
    const LightTable lights(traced, none, EmitterSampling::both);
    for (int i = 0; i < 10000; ++i) {
        const LightSample sample = lights.sample_without_extent(receiver, IndependentNumbers(8, i).u.x);
        const Arriving& light = lamps.arriving[static_cast<std::size_t>(lamps.find(sample.direction))];
        for (int c = 0; c < 3; ++c) {
            // Some ten roundings of float32; a spot's fading takes the difference of two cosines, which loses as many
            // digits as it is smaller than they: one.
            EXPECT_NEAR(sample.radiance[c] * light.weight() / lamps.sum(), light.radiance[c], 1e-5 * light.radiance[c])
                << i;
        }
        EXPECT_EQ(sample.density, 0.0f);
    }
}

}  // namespace
}  // namespace plumb
