#include "rasterizer/calibrating_workload.h"

#include <array>

#include <fmt/format.h>

namespace plumb {

CalibratingWorkload::CalibratingWorkload(GlContext& context)
    : context_(context),
      programs_(context, {{"CELLS", fmt::format("{}", cells)}, {"TAPS", fmt::format("{}", taps)}}),
      surface_(GlTexture::flat(context, GL_RGBA16F, size, size)),
      depth_(GlTexture::flat(context, GL_DEPTH_COMPONENT32F, size, size)),
      gathered_(GlTexture::flat(context, GL_RGBA16F, size, size)),
      surface_target_(context, std::array{GlAttachment{&surface_}}, {&depth_}, "calibrating workload: triangles"),
      gathered_target_(context, std::array{GlAttachment{&gathered_}}, {}, "calibrating workload: taps"),
      triangles_(programs_.get({"calibrating_workload.vert", "calibrating_workload.frag"})),
      gather_(context, programs_, "calibrating_workload_taps.frag"),
      no_vertices_(context),
      timer_(context, 1) {}

void CalibratingWorkload::draw() const {
    constexpr std::array nothing = {0.0f, 0.0f, 0.0f, 0.0f};
    constexpr float far_away = 1.0f;
    const GladGLContext& gl = context_.gl;
    surface_target_.bind();
    gl.ClearNamedFramebufferfv(surface_target_.id(), GL_COLOR, 0, nothing.data());
    gl.ClearNamedFramebufferfv(surface_target_.id(), GL_DEPTH, 0, &far_away);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_LESS);
    triangles_.use();
    no_vertices_.bind();
    gl.DrawArrays(GL_TRIANGLES, 0, 6 * cells * cells);
    gl.Disable(GL_DEPTH_TEST);

    surface_.bind(0);
    gather_.draw(gathered_target_);
}

double CalibratingWorkload::milliseconds(double least_milliseconds) {
    constexpr int most_rounds = 1 << 16;
    context_.make_current();
    while (true) {
        timer_.begin(0);
        for (int round = 0; round < rounds_; ++round) draw();
        timer_.end(0);
        const double elapsed = timer_.milliseconds().front();
        if (elapsed >= least_milliseconds || rounds_ >= most_rounds) {
            context_.check("calibrating workload");
            return elapsed / rounds_;
        }
        rounds_ *= 2;
    }
}

}  // namespace plumb
