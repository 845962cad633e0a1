#include "tests/agreement/gbuffer_agreement.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/glm.hpp>

namespace plumb::test {
namespace {

constexpr float edge_depth_jump = 0.002f;  // relative
constexpr float edge_cosine = 0.9659258f;  // 15 degrees

glm::vec3 vector_at(const Image& image, int x, int y) {
    const auto pixel = image.pixel(x, y);
    return {pixel[0], pixel[1], pixel[2]};
}

bool is_hit(float depth) { return std::isfinite(depth); }

// Depth at which the ray through pixel `to` meets the tangent plane of the surface seen at pixel `from`.
float predicted_depth(const View& view, const Image& depth, const Image& normal, glm::ivec2 from, glm::ivec2 to) {
    const glm::mat3 camera_from_world(view.camera_from_world());
    const glm::vec3 n = camera_from_world * vector_at(normal, from.x, from.y);
    const glm::vec3 p = view.camera_space_point(from.x + 0.5f, from.y + 0.5f, depth.at(from.x, from.y));
    const glm::vec3 per_metre = view.camera_space_point(to.x + 0.5f, to.y + 0.5f, 1.0f);
    return glm::dot(n, p) / glm::dot(n, per_metre);
}

bool is_edge_between(const View& view, const Image& depth, const Image& normal, glm::ivec2 p, glm::ivec2 q) {
    const float depth_p = depth.at(p.x, p.y), depth_q = depth.at(q.x, q.y);
    if (is_hit(depth_p) != is_hit(depth_q)) return true;
    if (!is_hit(depth_p)) return false;
    if (glm::dot(vector_at(normal, p.x, p.y), vector_at(normal, q.x, q.y)) < edge_cosine) return true;
    // Written so that a prediction of infinity or NaN (a plane seen edge-on) is an edge.
    return !(std::abs(predicted_depth(view, depth, normal, p, q) - depth_q) <= edge_depth_jump * depth_q &&
             std::abs(predicted_depth(view, depth, normal, q, p) - depth_p) <= edge_depth_jump * depth_p);
}

bool is_at_edge(const View& view, const Frame& exact, const std::string& prefix, int x, int y) {
    const Image& depth = exact.plane(prefix + "depth");
    const Image& normal = exact.plane(prefix + "normal");
    for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
            const glm::ivec2 q{std::clamp(x + dx, 0, depth.width() - 1), std::clamp(y + dy, 0, depth.height() - 1)};
            if (is_edge_between(view, depth, normal, {x, y}, q)) return true;
        }
    }
    return false;
}

}  // namespace

std::string AgreementCount::summary() const {
    return fmt::format(
        "{:.4f} % of {} pixels agree ({} at edges left out); wrong: {} hit or miss, {} depth, {} normal, {} albedo",
        100.0 * fraction(), pixels, at_edges, wrong_hit, wrong_depth, wrong_normal, wrong_albedo);
}

AgreementCount compare_gbuffers(const View& view, const Frame& rasterized, const Frame& exact,
                                const std::string& prefix, const AgreementTolerance& tolerance) {
    const Image &depth_a = rasterized.plane(prefix + "depth"), &depth_b = exact.plane(prefix + "depth");
    const Image &normal_a = rasterized.plane(prefix + "normal"), &normal_b = exact.plane(prefix + "normal");
    const Image &albedo_a = rasterized.plane(prefix + "albedo"), &albedo_b = exact.plane(prefix + "albedo");
    const float least_cosine = std::cos(glm::radians(tolerance.normal_degrees));

    AgreementCount count;
    count.wrong = Image(exact.width(), exact.height(), 1);
    for (int y = 0; y < exact.height(); ++y) {
        for (int x = 0; x < exact.width(); ++x) {
            if (is_at_edge(view, exact, "", x, y) || (!prefix.empty() && is_at_edge(view, exact, prefix, x, y))) {
                ++count.at_edges;
                count.wrong.at(x, y) = 0.25f;
                continue;
            }
            ++count.pixels;
            const float a = depth_a.at(x, y), b = depth_b.at(x, y);
            bool agrees = is_hit(a) == is_hit(b);
            if (!agrees) ++count.wrong_hit;
            if (agrees && is_hit(b)) {
                const bool depth_agrees = std::abs(a - b) <= tolerance.relative_depth * b;
                const bool normal_agrees =
                    glm::dot(glm::normalize(vector_at(normal_a, x, y)), vector_at(normal_b, x, y)) >= least_cosine;
                const glm::vec3 difference = glm::abs(vector_at(albedo_a, x, y) - vector_at(albedo_b, x, y));
                const bool albedo_agrees = std::max({difference.x, difference.y, difference.z}) <= tolerance.albedo;
                count.wrong_depth += !depth_agrees;
                count.wrong_normal += !normal_agrees;
                count.wrong_albedo += !albedo_agrees;
                agrees = depth_agrees && normal_agrees && albedo_agrees;
            }
            if (agrees)
                ++count.agreeing;
            else
                count.wrong.at(x, y) = 1.0f;
        }
    }
    return count;
}

}  // namespace plumb::test
