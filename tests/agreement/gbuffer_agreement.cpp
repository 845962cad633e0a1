#include "tests/agreement/gbuffer_agreement.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/glm.hpp>

namespace plumb::test {
namespace {

glm::vec3 vector_at(const Image& image, int x, int y) {
    const auto pixel = image.pixel(x, y);
    return {pixel[0], pixel[1], pixel[2]};
}

}  // namespace

std::string AgreementCount::summary() const {
    return fmt::format(
        "{:.4f} % of {} pixels agree ({} at silhouettes left out); wrong: {} hit or miss, {} depth, {} normal, {} "
        "albedo; "
        "{} pixels of these on coincident surfaces",
        100.0 * fraction(), pixels, silhouettes, wrong_hit, wrong_depth, wrong_normal, wrong_albedo,
        wrong_at_coincident);
}

void AgreementCount::add(const AgreementCount& other) {
    pixels += other.pixels;
    agreeing += other.agreeing;
    silhouettes += other.silhouettes;
    wrong_hit += other.wrong_hit;
    wrong_depth += other.wrong_depth;
    wrong_normal += other.wrong_normal;
    wrong_albedo += other.wrong_albedo;
    wrong_at_coincident += other.wrong_at_coincident;
}

AgreementCount compare_gbuffers(const Frame& rasterized, const Frame& exact, const std::string& prefix,
                                const Image& silhouettes, const Image& coincident,
                                const AgreementTolerance& tolerance) {
    const Image &depth_a = rasterized.plane(prefix + "depth"), &depth_b = exact.plane(prefix + "depth");
    const Image &normal_a = rasterized.plane(prefix + "normal"), &normal_b = exact.plane(prefix + "normal");
    const Image &albedo_a = rasterized.plane(prefix + "albedo"), &albedo_b = exact.plane(prefix + "albedo");
    const float least_cosine = std::cos(glm::radians(tolerance.normal_degrees));

    AgreementCount count;
    count.wrong = Image(exact.width(), exact.height(), 1);
    for (int y = 0; y < exact.height(); ++y) {
        for (int x = 0; x < exact.width(); ++x) {
            if (silhouettes.at(x, y) != 0.0f) {
                ++count.silhouettes;
                count.wrong.at(x, y) = 0.25f;
                continue;
            }
            ++count.pixels;
            const float a = depth_a.at(x, y), b = depth_b.at(x, y);
            bool agrees = std::isfinite(a) == std::isfinite(b);
            if (!agrees) ++count.wrong_hit;
            if (agrees && std::isfinite(b)) {
                const bool depth_agrees = std::abs(a - b) <= tolerance.relative_depth * b;
                const glm::vec3 normal = glm::normalize(vector_at(normal_a, x, y));
                const bool normal_agrees = glm::dot(normal, vector_at(normal_b, x, y)) >= least_cosine;
                const glm::vec3 difference = glm::abs(vector_at(albedo_a, x, y) - vector_at(albedo_b, x, y));
                const bool albedo_agrees = std::max({difference.x, difference.y, difference.z}) <= tolerance.albedo;
                count.wrong_depth += !depth_agrees;
                count.wrong_normal += !normal_agrees;
                count.wrong_albedo += !albedo_agrees;
                agrees = depth_agrees && normal_agrees && albedo_agrees;
            }
            if (agrees) {
                ++count.agreeing;
            } else {
                count.wrong.at(x, y) = 1.0f;
                count.wrong_at_coincident += coincident.at(x, y) != 0.0f;
            }
        }
    }
    return count;
}

}  // namespace plumb::test
