#include "scenes/specular_albedo.h"

#include <algorithm>

#include <glm/gtc/constants.hpp>

namespace plumb {
namespace {

struct GaussRule {
    std::vector<double> points, weights;  // on [0, 1]
};

// Gauss-Legendre: roots of the Legendre polynomial by Newton's iteration from Tricomi's estimate.
GaussRule gauss_rule(int order) {
    GaussRule rule;
    for (int i = 0; i < order; ++i) {
        double x = std::cos(glm::pi<double>() * (i + 0.75) / (order + 0.5)), slope = 1.0;
        for (int iteration = 0; iteration < 8; ++iteration) {  // quadratic convergence: 4 would do
            double current = 1.0, previous = 0.0;
            for (int n = 0; n < order; ++n) {
                const double next = ((2 * n + 1) * x * current - n * previous) / (n + 1);
                previous = current, current = next;
            }
            slope = order * (x * current - previous) / (x * x - 1.0);
            x -= current / slope;
        }
        rule.points.push_back(0.5 * (x + 1.0));
        rule.weights.push_back(1.0 / ((1.0 - x * x) * slope * slope));
    }
    return rule;
}

constexpr float smallest_root = 0.17782794f;  // smallest_ggx_alpha^(1/4)

double column_scale(double alpha) { return alpha / (1.0 + 8.0 * alpha); }

// Integrates the weight F G2 / G1 of reflection about the normals visible from wo (see pathtracer/microfacet.h) over
// the numbers they are drawn with: the azimuth (half of it, by symmetry) and the squared radius of the cap's disc. The
// weight falls to 0 where reflection reaches the horizon, which happens at one radius per azimuth; that is found first,
// for beyond it the weight is 0 and has a kink at the border.
class AlbedoIntegral {
public:
    AlbedoIntegral(double cosine_o, double alpha)
        : cosine_o_(cosine_o),
          sine_o_(std::sqrt(std::max(0.0, 1.0 - cosine_o * cosine_o))),
          alpha_(alpha),
          root_o_(smith_root(cosine_o, alpha)) {
        const double length = std::hypot(alpha * sine_o_, cosine_o);
        view_x_ = alpha * sine_o_ / length, view_z_ = cosine_o / length;
    }

    glm::dvec2 over(const GaussRule& azimuths, const GaussRule& radii) const {
        glm::dvec2 sum(0.0);
        for (std::size_t i = 0; i < azimuths.points.size(); ++i) {
            const double azimuth = glm::pi<double>() * azimuths.points[i];
            const double cosine = std::cos(azimuth), sine = std::sin(azimuth);
            const double above = horizon(cosine, sine);
            for (std::size_t j = 0; j < radii.points.size(); ++j) {
                const Reflection reflection = reflect(above * radii.points[j], cosine, sine);
                if (!(reflection.cosine_i > 0.0)) continue;
                const double root_i = smith_root(reflection.cosine_i, alpha_);
                const double weight = azimuths.weights[i] * radii.weights[j] * above * reflection.cosine_i *
                                      (cosine_o_ + root_o_) / (cosine_o_ * root_i + reflection.cosine_i * root_o_);
                const double share = schlick_weight(reflection.cosine_oh);
                sum += weight * glm::dvec2(1.0 - share, share);
            }
        }
        return sum;
    }

private:
    // The squared radius up to which directions lie above the horizon: at 0 they always do, at 1 never. By false
    // position (Illinois), to a cosine at which the weight is nearly 0 anyway.
    double horizon(double cosine_azimuth, double sine_azimuth) const {
        double above = 0.0, below = 1.0, middle = 1.0;
        double at_above = reflect(above, cosine_azimuth, sine_azimuth).cosine_i, at_below = -cosine_o_;
        for (int step = 0; step < 12; ++step) {
            middle = (above * at_below - below * at_above) / (at_below - at_above);
            const double at_middle = reflect(middle, cosine_azimuth, sine_azimuth).cosine_i;
            if (std::abs(at_middle) < 1e-3 * alpha_) break;
            if (at_middle > 0.0) {
                above = middle, at_above = at_middle, at_below *= 0.5;
            } else {
                below = middle, at_below = at_middle, at_above *= 0.5;
            }
        }
        return middle;
    }

    struct Reflection {
        double cosine_oh, cosine_i;
    };

    Reflection reflect(double squared_radius, double cosine_azimuth, double sine_azimuth) const {
        const double z = (1.0 - squared_radius) * (1.0 + view_z_);
        const double across = std::sqrt(squared_radius * (1.0 + view_z_) * (z + 1.0 - view_z_));
        const double x = alpha_ * (across * cosine_azimuth + view_x_), y = alpha_ * across * sine_azimuth;
        const double length = std::sqrt(x * x + y * y + z * z);
        const double cosine_oh = (sine_o_ * x + cosine_o_ * z) / length;
        return {cosine_oh, 2.0 * cosine_oh * z / length - cosine_o_};
    }

    double cosine_o_, sine_o_, alpha_, root_o_, view_x_ = 0.0, view_z_ = 1.0;
};

}  // namespace

glm::dvec2 integrate_specular_albedo(double cosine_o, double alpha, int order) {
    const GaussRule rule = gauss_rule(order);
    return AlbedoIntegral(cosine_o, alpha).over(rule, rule);
}

SpecularAlbedo::SpecularAlbedo() {
    const GaussRule azimuths = gauss_rule(16), radii = gauss_rule(12);  // to 1e-3, a third of the interpolation's error
    for (int row = 0; row < rows; ++row) {
        const double root = smallest_root + (1.0 - smallest_root) * row / (rows - 1);
        const double alpha = root * root * root * root;
        const double scale = column_scale(alpha);
        for (int column = 0; column < columns; ++column) {
            const double cosine = scale * std::sinh(std::asinh(1.0 / scale) * column / (columns - 1));
            const AlbedoIntegral integral(std::min(cosine, 1.0), alpha);
            table_.emplace_back(integral.over(azimuths, radii));
        }
    }
}

glm::vec2 SpecularAlbedo::table_coordinates(float cosine_o, float alpha) {
    const auto scale = static_cast<float>(column_scale(alpha));
    const auto asinh_scaled = [scale](float x) { return std::log((x + std::sqrt(x * x + scale * scale)) / scale); };
    return {asinh_scaled(cosine_o) / asinh_scaled(1.0f),
            (std::sqrt(std::sqrt(alpha)) - smallest_root) / (1.0f - smallest_root)};
}

glm::vec2 SpecularAlbedo::split(float cosine_o, float alpha) const {
    if (alpha == 0.0f) {
        const float share = schlick_weight(cosine_o);
        return {1.0f - share, share};
    }
    const glm::vec2 last(columns - 1, rows - 1);
    const glm::vec2 at = glm::clamp(table_coordinates(cosine_o, alpha), 0.0f, 1.0f) * last;
    const glm::vec2 corner = glm::min(glm::floor(at), last - 1.0f), part = at - corner;
    const glm::vec2* texel = &table_[static_cast<std::size_t>(corner.y) * columns + static_cast<std::size_t>(corner.x)];
    return glm::mix(glm::mix(texel[0], texel[1], part.x), glm::mix(texel[columns], texel[columns + 1], part.x), part.y);
}

}  // namespace plumb
