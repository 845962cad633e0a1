#include "rasterizer/moment.h"

namespace plumb {
namespace {

bool same(const View& a, const View& b) {
    const Camera &first = a.camera(), &second = b.camera();
    return a.width() == b.width() && a.height() == b.height() && first.world_from_camera == second.world_from_camera &&
           first.vertical_fov == second.vertical_fov && first.near_plane == second.near_plane &&
           first.far_plane == second.far_plane && a.offset() == b.offset();
}

}  // namespace

bool Moment::operator==(const Moment& other) const { return same(view, other.view) && time == other.time; }

glm::mat4 extrapolate(const glm::mat4& previous, const glm::mat4& now) {
    if (previous == now) return now;  // exactly, whatever rounding would do
    const glm::dmat4 moved = glm::dmat4(now) * glm::inverse(glm::dmat4(previous));
    return glm::mat4(moved * glm::dmat4(now));
}

View extrapolate(const View& previous, const View& now) {
    Camera camera = now.camera();
    camera.world_from_camera = extrapolate(previous.camera().world_from_camera, camera.world_from_camera);
    return View(camera, now.width(), now.height()).with_offset(now.offset());
}

}  // namespace plumb
