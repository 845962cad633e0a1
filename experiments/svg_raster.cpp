#include "experiments/svg_raster.h"

#include <cmath>
#include <memory>

#include <cairo.h>
#include <fmt/format.h>
#include <librsvg/rsvg.h>

#include "frames/image_error.h"

namespace plumb {
namespace {

struct Deleter {
    void operator()(RsvgHandle* handle) const { g_object_unref(handle); }
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    void operator()(cairo_t* context) const { cairo_destroy(context); }
    void operator()(GError* error) const { g_error_free(error); }
};
template <class Type>
using Owned = std::unique_ptr<Type, Deleter>;

[[noreturn]] void fail_drawing(GError* error) {
    const Owned<GError> owned(error);
    throw ImageError(fmt::format("cannot draw the SVG: {}", error ? error->message : "no reason was given"));
}

void require(cairo_status_t status) {
    if (status != CAIRO_STATUS_SUCCESS)
        throw ImageError(fmt::format("cannot draw the SVG: {}", cairo_status_to_string(status)));
}

cairo_status_t append(void* text, const unsigned char* bytes, unsigned int count) {
    static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), count);
    return CAIRO_STATUS_SUCCESS;
}

}  // namespace

std::string rasterise_svg(std::string_view svg, double scale) {
    GError* error = nullptr;
    const Owned<RsvgHandle> handle(
        rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &error));
    if (!handle) fail_drawing(error);
    double width = 0.0, height = 0.0;
    if (!rsvg_handle_get_intrinsic_size_in_pixels(handle.get(), &width, &height))
        throw ImageError("cannot draw the SVG: it has no width and height in pixels");

    const Owned<cairo_surface_t> surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32,
                                                                    static_cast<int>(std::lround(scale * width)),
                                                                    static_cast<int>(std::lround(scale * height))));
    require(cairo_surface_status(surface.get()));
    const Owned<cairo_t> context(cairo_create(surface.get()));
    const RsvgRectangle viewport{0.0, 0.0, scale * width, scale * height};
    if (!rsvg_handle_render_document(handle.get(), context.get(), &viewport, &error)) fail_drawing(error);
    require(cairo_status(context.get()));
    std::string png;
    require(cairo_surface_write_to_png_stream(surface.get(), append, &png));
    return png;
}

}  // namespace plumb
