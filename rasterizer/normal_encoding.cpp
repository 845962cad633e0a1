#include "rasterizer/normal_encoding.h"

namespace plumb {

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

}  // namespace plumb
