// What lies along the rays of a view's pixels, whatever a method makes of it: how many surfaces, and which side the
// second layer shows.
#pragma once

#include "pathtracer/traced_scene.h"
#include "scenes/camera.h"

namespace plumb {

// The mean number of surfaces along a pixel's ray between the camera's planes, over the pixels that show any: what
// forward rendering without a depth pass may shade for one pixel that deferred rendering shades once. NaN where nothing
// is seen.
double surfaces_per_pixel(const TracedScene& scene, const View& view);

// Of the pixels whose second layer, the nearest surface deeper than the first by more than `minimum_separation` (metres
// along the view axis), holds something: the share whose triangle winds clockwise as seen, so that it would be culled.
// NaN where none holds anything.
double back_face_share(const TracedScene& scene, const View& view, float minimum_separation);

}  // namespace plumb
