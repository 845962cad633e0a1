#include "metrics/flip_colour.h"

#include <bit>
#include <cmath>
#include <cstdint>

namespace plumb {
namespace {

constexpr double colour_exponent = 0.7;             // q_c
constexpr double knee = 0.4, value_at_knee = 0.95;  // p_c, p_t

// Of Rec.709 primaries and D65, in the fractions that the source prints; columns are red, green, blue.
const glm::dmat3 xyz_from_rgb(10135552.0 / 24577794.0, 2613072.0 / 12288897.0, 1425312.0 / 73733382.0,  //
                              8788810.0 / 24577794.0, 8788810.0 / 12288897.0, 8788810.0 / 73733382.0,   //
                              4435075.0 / 24577794.0, 887015.0 / 12288897.0, 70074185.0 / 73733382.0);
const glm::dvec3 white = xyz_from_rgb * glm::dvec3(1.0);

// RGB to XYZ over the white point's, and back.
const glm::mat3 relative_xyz_from_rgb(glm::dmat3(1.0 / white.x, 0.0, 0.0, 0.0, 1.0 / white.y, 0.0, 0.0, 0.0,
                                                 1.0 / white.z) *
                                      xyz_from_rgb);
const glm::mat3 rgb_from_relative_xyz(glm::inverse(glm::dmat3(relative_xyz_from_rgb)));

// Of positive numbers, to a float's precision, in a third of the time of std::pow and a ninth of that of std::cbrt,
// which take half of FLIP's. A third of the exponent is a guess within 4 %, and each of Halley's steps cubes what is
// wrong with it.
//   Source: Kahan 1991, "Computing a Real Cube Root"; the guess's constant is that of FreeBSD's cbrtf.
float cube_root(float t) {
    float root = std::bit_cast<float>(std::bit_cast<std::uint32_t>(t) / 3 + 709958130u);
    for (int step = 0; step < 2; ++step) {
        const float cube = root * root * root;
        root *= (cube + 2.0f * t) / (2.0f * cube + t);
    }
    return root;
}

float lab_curve(float t) {
    constexpr float edge = 6.0f / 29.0f;
    return t > edge * edge * edge ? cube_root(t) : t / (3.0f * edge * edge) + 4.0f / 29.0f;
}

// CIELAB with colour differences that shrink with the lightness, as they do to the eye (Hunt).
glm::vec3 hunt_lab_from_rgb(const glm::vec3& rgb) {
    const glm::vec3 xyz = relative_xyz_from_rgb * rgb;
    const float x = lab_curve(xyz.x), y = lab_curve(xyz.y), z = lab_curve(xyz.z);
    const float lightness = 116.0f * y - 16.0f;
    return {lightness, 0.01f * lightness * 500.0f * (x - y), 0.01f * lightness * 200.0f * (y - z)};
}

float hyab(const glm::vec3& a, const glm::vec3& b) {
    const glm::vec3 d = a - b;
    return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

// The largest difference of two colours, which stands for 1.
const auto largest_colour_difference = static_cast<float>(
    std::pow(hyab(hunt_lab_from_rgb({0.0f, 1.0f, 0.0f}), hunt_lab_from_rgb({0.0f, 0.0f, 1.0f})), colour_exponent));

}  // namespace

double luminance(const glm::dvec3& rgb) {
    return xyz_from_rgb[0].y * rgb.r + xyz_from_rgb[1].y * rgb.g + xyz_from_rgb[2].y * rgb.b;
}

glm::vec3 opponent_from_rgb(const glm::vec3& rgb) {
    const glm::vec3 xyz = relative_xyz_from_rgb * rgb;
    return {116.0f * xyz.y - 16.0f, 500.0f * (xyz.x - xyz.y), 200.0f * (xyz.y - xyz.z)};
}

glm::vec3 rgb_from_opponent(const glm::vec3& opponent) {
    const float y = (opponent.x + 16.0f) / 116.0f;
    return rgb_from_relative_xyz * glm::vec3(y + opponent.y / 500.0f, y, y - opponent.z / 200.0f);
}

float colour_difference(const glm::vec3& test, const glm::vec3& reference) {
    const float distance =
        std::pow(hyab(hunt_lab_from_rgb(test), hunt_lab_from_rgb(reference)), static_cast<float>(colour_exponent));
    const auto bend = static_cast<float>(knee) * largest_colour_difference;
    constexpr auto there = static_cast<float>(value_at_knee);
    return distance < bend ? distance * there / bend
                           : there + (distance - bend) / (largest_colour_difference - bend) * (1.0f - there);
}

}  // namespace plumb
