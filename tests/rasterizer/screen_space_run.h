// Runs the screen-space passes on layers that a test makes up, through the pipeline's own plan.
#pragma once

#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "layer_upload.h"
#include "rasterizer/ambient_obscurance.h"
#include "rasterizer/depth_key_pass.h"
#include "rasterizer/depth_mip_chain.h"
#include "rasterizer/pass_plan.h"
#include "rasterizer/radiosity.h"
#include "rasterizer/texture_transfer.h"
#include "rasterizer/view_uniforms.h"
#include "sample_spiral_counterpart.h"

namespace plumb {

class ScreenSpaceRun {
public:
    ScreenSpaceRun(GlContext& context, counterpart::Layers layers, Method method, Quantities quantities,
                   std::vector<PassDeclaration> further_passes = {})
        : context_(context),
          layers_(std::move(layers)),
          method_(std::move(method)),
          quantities_(std::move(quantities)),
          planes_(context, layers_.width(), layers_.height()),
          programs_(context),
          view_uniforms_(context) {
        upload_layers(planes_, layers_);
        GlTexture& albedo = planes_.create("albedo", GL_RGBA32F, 2);
        for (int layer = 0; layer < 2; ++layer) {
            upload(albedo, layer, Image(layers_.width(), layers_.height(), 3, 0.5f));
        }
        std::vector<PassDeclaration> declarations = {
            {"given",
             {},
             {"depth", "normal", "direct", "albedo", "layer2.depth", "layer2.normal", "layer2.direct", "layer2.albedo"},
             [](const PassResources&) { return nullptr; }}};
        const auto add = [&](std::vector<PassDeclaration> more) {
            for (PassDeclaration& pass : more) declarations.push_back(std::move(pass));
        };
        add(declare_depth_mip_chain());
        add(declare_depth_keys());
        add(declare_ambient_obscurance(method_, quantities_));
        add(declare_radiosity(scene_, method_));
        add(std::move(further_passes));
        const PassPlan plan = plan_passes(declarations, quantities_.planes);
        const PassResources resources{
            context_,  scene_,
            method_,   quantities_,
            planes_,   programs_,
            plan.read, []() -> const SceneGeometry& {
                                          throw std::logic_error("no pass here draws geometry"); }};
        for (const std::size_t index : plan.order) {
            if (std::unique_ptr<Pass> pass = declarations[index].create(resources)) passes_.push_back(std::move(pass));
        }
    }

    // Runs all passes and returns a plane, guard band included.
    Image render(const std::string& plane, int channels, int layer = 0, int level = 0, std::uint32_t seed = 0,
                 int frame = 0) {
        context_.make_current();
        view_uniforms_.update(layers_.view, layers_.view, method_.gbuffer.guard_band, nullptr, frame,
                              pattern_shift(seed));
        view_uniforms_.bind();
        for (const std::unique_ptr<Pass>& pass : passes_) {
            pass->execute({layers_.view, layers_.view, nullptr});
        }
        context_.check("screen-space passes");
        return read_back(planes_.get(plane), layer, channels, 0, level);
    }

    // What the passes see: normals as their encoding leaves them.
    const counterpart::Layers& layers() const { return layers_; }
    const PlaneTextures& planes() const { return planes_; }

private:
    GlContext& context_;
    counterpart::Layers layers_;
    Method method_;
    Quantities quantities_;
    Scene scene_;
    PlaneTextures planes_;
    ProgramCache programs_;
    ViewUniforms view_uniforms_;
    std::vector<std::unique_ptr<Pass>> passes_;
};

// Of so many patterns of taps.
inline Image mean_over_seeds(ScreenSpaceRun& run, const std::string& plane, int channels, int seeds, int layer = 0) {
    Image mean = run.render(plane, channels, layer);
    for (int seed = 1; seed < seeds; ++seed) {
        const Image image = run.render(plane, channels, layer, 0, static_cast<std::uint32_t>(seed));
        for (std::size_t i = 0; i < mean.values().size(); ++i) mean.values()[i] += image.values()[i];
    }
    for (float& value : mean.values()) value /= static_cast<float>(seeds);
    return mean;
}

// A flat, rectangular surface, in camera space.
struct Patch {
    glm::vec3 corner, edge_u, edge_v;
};

// What a view of patches sees: exact depths and normals of the nearest two surfaces at least `separation` apart;
// radiance is `radiance` everywhere.
inline counterpart::Layers layers_of_patches(const View& view, const std::vector<Patch>& patches,
                                             float separation = 0.1f, float radiance = 1.0f) {
    const int width = view.width(), height = view.height();
    counterpart::Layers layers{view, {}, {}, {}};
    for (int layer = 0; layer < 2; ++layer) {
        layers.depth.emplace_back(width, height, 1);
        layers.normal.emplace_back(width, height, 3);
        layers.radiance.emplace_back(width, height, 3, radiance);
    }
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const glm::dvec3 ray(view.camera_space_point(x + 0.5f, y + 0.5f, 1.0f));
            for (int layer = 0; layer < 2; ++layer) {
                const double nearest_allowed = layer == 0 ? 0.0 : layers.depth[0].at(x, y) + separation;
                double nearest = std::numeric_limits<double>::infinity();
                if (layer == 1 && layers.depth[0].at(x, y) == 0.0f) continue;
                for (const Patch& patch : patches) {
                    const glm::dvec3 u(patch.edge_u), v(patch.edge_v), corner(patch.corner);
                    glm::dvec3 normal = glm::normalize(glm::cross(u, v));
                    const double depth = glm::dot(corner, normal) / glm::dot(ray, normal);
                    const glm::dvec3 inside = depth * ray - corner;
                    const double a = glm::dot(inside, u) / glm::dot(u, u), b = glm::dot(inside, v) / glm::dot(v, v);
                    if (!(depth > nearest_allowed && depth < nearest && a >= 0 && a <= 1 && b >= 0 && b <= 1)) continue;
                    nearest = depth;
                    if (glm::dot(normal, ray) > 0.0) normal = -normal;
                    layers.depth[layer].at(x, y) = static_cast<float>(depth);
                    for (int c = 0; c < 3; ++c) layers.normal[layer].at(x, y, c) = static_cast<float>(normal[c]);
                }
            }
        }
    }
    return layers;
}

// A view that looks neither along an axis nor is level, so that spaces cannot be mixed up unseen.
inline View slanted_view(int width, int height) {
    return View(Camera::look_at("slanted", {1.0f, 2.0f, 3.0f}, {-2.0f, 0.5f, 1.0f}, 0.9f), width, height);
}

// What the G-buffer and direct light of a pipeline left for the screen-space passes; `frame` holds both layers' planes.
inline counterpart::Layers layers_of_frame(const View& view, const Frame& frame) {
    counterpart::Layers layers{view, {}, {}, {}};
    const glm::mat3 camera_from_world(view.camera_from_world());
    for (const std::string prefix : {"", "layer2."}) {
        Image depth = frame.plane(prefix + "depth"), normal = frame.plane(prefix + "normal");
        for (float& value : depth.values()) {
            if (std::isinf(value)) value = 0.0f;
        }
        for (int y = 0; y < view.height(); ++y) {
            for (int x = 0; x < view.width(); ++x) {
                auto n = normal.pixel(x, y);
                const glm::vec3 camera_normal = camera_from_world * glm::vec3(n[0], n[1], n[2]);
                for (int c = 0; c < 3; ++c) n[c] = camera_normal[c];
            }
        }
        layers.depth.push_back(depth);
        layers.normal.push_back(normal);
        layers.radiance.push_back(frame.plane(prefix + "direct"));
    }
    return layers;
}

// The planes that it takes.
inline const std::vector<std::string> planes_of_layers = {"depth",        "normal",        "direct",
                                                          "layer2.depth", "layer2.normal", "layer2.direct"};

}  // namespace plumb
