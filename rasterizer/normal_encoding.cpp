#include "rasterizer/normal_encoding.h"

#include <array>

namespace plumb {
namespace {

struct FormatFacts {
    GLenum texture;
    int channels;
    const char* encoding;  // of normal_encoding.glsl
};

const FormatFacts& facts_of(NormalFormat format) {
    static constexpr std::array<FormatFacts, 7> facts = {{{GL_RG16, 2, "OCTAHEDRAL"},
                                                          {GL_RG8, 2, "OCTAHEDRAL"},
                                                          {GL_RGBA32F, 3, "SIGNED_VECTOR"},
                                                          {GL_RGBA16F, 3, "SIGNED_VECTOR"},
                                                          {GL_RGB10_A2, 3, "UNSIGNED_VECTOR"},
                                                          {GL_R11F_G11F_B10F, 3, "UNSIGNED_VECTOR"},
                                                          {GL_RG8, 2, "CAMERA_XY"}}};
    return facts.at(static_cast<std::size_t>(format));
}

}  // namespace

glm::vec2 encode_normal(const glm::vec3& normal) {
    glm::vec2 p = glm::vec2(normal) / (glm::abs(normal.x) + glm::abs(normal.y) + glm::abs(normal.z));
    if (normal.z < 0.0f) {
        p = (1.0f - glm::abs(glm::vec2(p.y, p.x))) * glm::vec2(p.x >= 0.0f ? 1.0f : -1.0f, p.y >= 0.0f ? 1.0f : -1.0f);
    }
    return 0.5f * p + 0.5f;
}

glm::vec3 decode_normal(const glm::vec2& encoded) {
    const glm::vec2 p = 2.0f * encoded - 1.0f;
    glm::vec3 n(p, 1.0f - glm::abs(p.x) - glm::abs(p.y));
    const float fold = glm::max(-n.z, 0.0f);
    n.x += n.x >= 0.0f ? -fold : fold;
    n.y += n.y >= 0.0f ? -fold : fold;
    return glm::normalize(n);
}

NormalFormat normal_format_of(const Method& method) {
    return method.gbuffer.source == SourceOfStage::truth ? NormalFormat::oct32 : method.gbuffer.normal_format;
}

GLenum texture_format(NormalFormat format) { return facts_of(format).texture; }

int channels_of(NormalFormat format) { return facts_of(format).channels; }

ShaderDefines normal_defines(NormalFormat format) { return {{"NORMAL_ENCODING", facts_of(format).encoding}}; }

glm::vec3 normal_of_texel(NormalFormat format, const glm::vec3& texel, const glm::mat3& world_from_camera) {
    switch (format) {
        case NormalFormat::oct32:
        case NormalFormat::oct16:
            return decode_normal(glm::vec2(texel));
        case NormalFormat::rgb32f:
        case NormalFormat::rgb16f:
            return glm::normalize(texel);
        case NormalFormat::rgb10a2:
        case NormalFormat::r11g11b10f:
            return glm::normalize(2.0f * texel - 1.0f);
        case NormalFormat::xy8:
            break;
    }
    const glm::vec2 xy = 2.0f * glm::vec2(texel) - 1.0f;
    return glm::normalize(world_from_camera * glm::vec3(xy, glm::sqrt(glm::max(0.0f, 1.0f - glm::dot(xy, xy)))));
}

}  // namespace plumb
