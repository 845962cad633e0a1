#include "rasterizer/plane_reader.h"

#include <cmath>

#include "rasterizer/instance_motion.h"
#include "rasterizer/normal_encoding.h"
#include "rasterizer/texture_transfer.h"

namespace plumb {
namespace {

int channels_of_plane(const std::string& base) {
    if (base == "depth" || base == "ao" || base == "roughness" || base == "confidence" ||
        base == moving_instance_plane || base.ends_with(".history_weight"))
        return 1;
    if (base == "motion") return 2;
    return 3;
}

void put(Image& image, int x, int y, const glm::vec3& value) {
    for (int c = 0; c < 3; ++c) image.at(x, y, c) = value[c];
}

}  // namespace

std::vector<std::string> planes_behind(const std::string& plane) {
    const auto [layer, base] = split_layer(plane);
    const std::string prefix = layer_prefix(layer);
    if (base == "position") return {prefix + "depth"};
    if (base == "normal") return {prefix + "depth", plane};
    return {plane};
}

Image read_plane(const PlaneTextures& planes, const std::string& plane, const View& view, int guard_band,
                 NormalFormat normal_format) {
    const auto [layer, base] = split_layer(plane);
    if (base != "normal" && base != "position")
        return read_back(planes.get(base), layer, channels_of_plane(base), guard_band);

    const Image depth = read_back(planes.get("depth"), layer, 1, guard_band);
    Image result(depth.width(), depth.height(), 3);
    const int channels = channels_of(normal_format);
    const Image encoded = base == "normal" ? read_back(planes.get("normal"), layer, channels, guard_band) : Image();
    const glm::mat3 world_from_camera(view.camera().world_from_camera);
    for (int y = 0; y < depth.height(); ++y) {
        for (int x = 0; x < depth.width(); ++x) {
            const float d = depth.at(x, y);
            if (std::isinf(d)) continue;
            if (base == "normal") {
                const glm::vec3 texel(encoded.at(x, y, 0), encoded.at(x, y, 1), encoded.at(x, y, channels - 1));
                put(result, x, y, normal_of_texel(normal_format, texel, world_from_camera));
            } else {
                const glm::vec3 p =
                    view.camera_space_point(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, d);
                put(result, x, y, glm::vec3(view.camera().world_from_camera * glm::vec4(p, 1.0f)));
            }
        }
    }
    return result;
}

}  // namespace plumb
