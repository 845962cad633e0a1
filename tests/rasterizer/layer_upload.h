// Puts layers that a test makes up where passes look for a G-buffer and its light.
#pragma once

#include <limits>

#include "rasterizer/normal_encoding.h"
#include "rasterizer/plane_textures.h"
#include "rasterizer/texture_transfer.h"
#include "sample_spiral_counterpart.h"

namespace plumb {

// Creates the planes depth, normal and direct of two layers, and camera_position where there are positions. Normals of
// `layers` become what their encoding leaves.
inline void upload_layers(PlaneTextures& planes, counterpart::Layers& layers) {
    const int width = layers.width(), height = layers.height();
    GlTexture& depth = planes.create("depth", GL_R32F, 2);
    GlTexture& normal = planes.create("normal", GL_RG16, 2);
    GlTexture& direct = planes.create("direct", GL_RGBA32F, 2);
    const glm::mat3 world_from_camera(layers.view.camera().world_from_camera);
    for (int layer = 0; layer < 2; ++layer) {
        Image depth_image = layers.depth[layer], encoded(width, height, 2);
        for (float& value : depth_image.values()) {
            if (value == 0.0f) value = std::numeric_limits<float>::infinity();
        }
        const auto for_each_pixel = [&](const auto& action) {
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) action(encoded.pixel(x, y), layers.normal[layer].pixel(x, y));
            }
        };
        for_each_pixel([&](auto code, auto n) {
            const glm::vec3 camera_normal(n[0], n[1], n[2]);
            if (camera_normal == glm::vec3(0.0f)) return;  // nothing there
            const glm::vec2 e = encode_normal(world_from_camera * camera_normal);
            code[0] = e.x, code[1] = e.y;
        });
        upload(normal, layer, encoded);
        encoded = read_back(normal, layer, 2);
        for_each_pixel([&](auto code, auto n) {
            const glm::vec3 camera_normal = glm::transpose(world_from_camera) * decode_normal({code[0], code[1]});
            for (int c = 0; c < 3; ++c) n[c] = camera_normal[c];
        });
        upload(depth, layer, depth_image);
        upload(direct, layer, layers.radiance[layer]);
        if (layers.position.empty()) continue;
        if (layer == 0) planes.create("camera_position", GL_RGBA32F, 2);
        upload(planes.get("camera_position"), layer, layers.position[layer]);
    }
}

}  // namespace plumb
