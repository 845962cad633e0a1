#include "rasterizer/truth_pass.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "rasterizer/gbuffer_planes.h"
#include "rasterizer/gl_error.h"
#include "rasterizer/instance_motion.h"
#include "rasterizer/normal_encoding.h"
#include "rasterizer/texture_transfer.h"

namespace plumb {
namespace {

GLenum format_of(std::string_view plane, const Scene& scene) {
    if (plane == "depth") return GL_R32F;
    if (plane == moving_instance_plane) return moving_instance_format(scene);
    if (plane == "normal") return GL_RG16;
    return GL_RGBA32F;  // as it comes: the point is to have no error of one's own
}

Image encoded_normals(const Image& normals) {
    Image encoded(normals.width(), normals.height(), 2);
    for (int y = 0; y < normals.height(); ++y) {
        for (int x = 0; x < normals.width(); ++x) {
            const glm::vec3 n(normals.at(x, y, 0), normals.at(x, y, 1), normals.at(x, y, 2));
            const glm::vec2 e = n == glm::vec3(0.0f) ? glm::vec2(0.5f) : encode_normal(n);  // zero: nothing is there
            encoded.at(x, y, 0) = e.x, encoded.at(x, y, 1) = e.y;
        }
    }
    return encoded;
}

Image numbers_of_moving(const Image& instances, const std::vector<int>& moving_numbers) {
    const auto count = static_cast<float>(moving_numbers.size());
    Image numbers(instances.width(), instances.height(), 1);
    std::ranges::transform(instances.values(), numbers.values().begin(), [&](float instance) {
        if (instance == -1.0f) return 0.0f;
        if (!(instance >= 0.0f && instance < count)) {
            throw MethodError(fmt::format(
                "the truth's plane 'instance' holds {}, and the scene has {} instances: it is of another scene",
                instance, moving_numbers.size()));
        }
        return static_cast<float>(moving_numbers[static_cast<std::size_t>(instance)]);
    });
    return numbers;
}

}  // namespace

TruthPass::TruthPass(const PassResources& resources, std::vector<std::string> planes)
    : moving_numbers_(moving_instance_numbers(resources.scene)) {
    for (std::string& plane : planes) {
        const auto [layer, base] = split_layer(plane);
        const bool is_kept = base == "depth" && any_layer_is_read(resources, gbuffer_history);
        if (base == gbuffer_history || !(is_kept || resources.is_read(plane))) continue;
        if (!resources.planes.has(base)) {
            const int layers = std::max(resources.layers_of(base), is_kept ? resources.layers_of(gbuffer_history) : 1);
            resources.planes.create(base, format_of(base, resources.scene), layers);
            if (is_kept) depth_history_ = &resources.planes.create_history(base, std::string(gbuffer_history));
        }
        const GlTexture& texture = resources.planes.get(base);
        if (layer >= texture.layers()) continue;
        uploads_.push_back(
            {layer_prefix(layer) + (base == moving_instance_plane ? "instance" : base), &texture, layer});
    }
}

void TruthPass::execute(const PassFrame& frame) {
    if (depth_history_) depth_history_->trade_places();
    for (const Upload& upload_one : uploads_) {
        if (frame.truth == nullptr || !frame.truth->has(upload_one.plane)) {
            throw MethodError(fmt::format(
                "the method takes '{}' from the truth, but the truth frame {}; render the reference with that plane",
                upload_one.plane,
                frame.truth == nullptr ? "is missing"
                                       : fmt::format("has only {}", fmt::join(frame.truth->plane_names(), ", "))));
        }
        const Image& image = frame.truth->plane(upload_one.plane);
        if (image.width() != upload_one.texture->width() || image.height() != upload_one.texture->height()) {
            throw MethodError(fmt::format("the truth frame is {}x{}, the pipeline renders {}x{}", image.width(),
                                          image.height(), upload_one.texture->width(), upload_one.texture->height()));
        }
        const std::string base = split_layer(upload_one.plane).base;
        if (base == "normal") {
            upload(*upload_one.texture, upload_one.layer, encoded_normals(image));
        } else if (base == "instance") {
            upload(*upload_one.texture, upload_one.layer, numbers_of_moving(image, moving_numbers_));
        } else {
            upload(*upload_one.texture, upload_one.layer, image);
        }
    }
}

PassDeclaration declare_true_gbuffer(const Scene& scene, const Method& method) {
    PassDeclaration pass;
    pass.name = "gbuffer.truth";
    std::vector<std::string> of_each_layer{"depth", "normal", "albedo", std::string(gbuffer_history)};
    if (anything_moves(scene)) of_each_layer.emplace_back(moving_instance_plane);
    pass.outputs = of_each_layer;
    pass.outputs.emplace_back("emission");
    const auto first_layer_outputs = static_cast<std::ptrdiff_t>(pass.outputs.size());
    for (int layer = 1; layer < method.gbuffer.layers; ++layer) {
        for (const std::string& plane : of_each_layer) pass.outputs.push_back(layer_prefix(layer) + plane);
    }
    pass.parameters = {{"gbuffer.source"}, {"gbuffer.layers"}};
    // The truth's layers are that far apart.
    const std::vector<std::string> behind(pass.outputs.begin() + first_layer_outputs, pass.outputs.end());
    if (!behind.empty()) pass.parameters.push_back({"gbuffer.minimum_separation", behind});
    pass.kept = {"depth"};
    pass.create = [planes = pass.outputs](const PassResources& resources) {
        return std::make_unique<TruthPass>(resources, planes);
    };
    if (method.gbuffer.source == SourceOfStage::method) pass.disabled = "gbuffer.source is \"method\"";
    return pass;
}

PassDeclaration declare_true_direct(const Method& method) {
    PassDeclaration pass;
    pass.name = "direct.truth";
    pass.outputs = {"direct"};
    pass.parameters = {{"direct.source"}};
    pass.create = [planes = pass.outputs](const PassResources& resources) {
        return std::make_unique<TruthPass>(resources, planes);
    };
    if (method.direct.source == SourceOfStage::method) pass.disabled = "direct.source is \"method\"";
    return pass;
}

}  // namespace plumb
