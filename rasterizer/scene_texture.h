// A texture of the scene in OpenGL: the very values, read as Texture::sample reads them.
#pragma once

#include "rasterizer/gl_objects.h"
#include "scenes/texture.h"

namespace plumb {

// Throws GlError where this OpenGL takes no texture as large.
GlTexture upload(GlContext& context, const Texture& texture);

}  // namespace plumb
