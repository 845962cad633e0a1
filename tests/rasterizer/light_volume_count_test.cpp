// How many fragments lights shade: against counts by rays and planes, for few lights and for many.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "gl_test.h"
#include "light_run.h"
#include "light_scenes.h"
#include "many_lamps.h"
#include "rasterizer/light_fragment_count.h"
#include "rasterizer/light_volumes.h"

namespace plumb {
namespace {

// A mesh around a light, and whether it holds a point: in front of no facet. Within `doubt` of a facet rounding
// decides.
struct PlacedVolume {
    PlacedVolume(const LightVolume& volume, const VolumeMesh& mesh) {
        const auto placed = [&](std::uint32_t index) {
            return glm::dvec3(glm::dmat4(volume.world_from_unit) * glm::dvec4(glm::dvec3(mesh.positions[index]), 1.0));
        };
        for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
            const glm::dvec3 a = placed(mesh.indices[t]), b = placed(mesh.indices[t + 1]),
                             c = placed(mesh.indices[t + 2]);
            const glm::dvec3 outwards = glm::normalize(glm::cross(b - a, c - a));
            facets.emplace_back(outwards, -glm::dot(outwards, a));
        }
    }
    double outside_by(const glm::dvec3& p) const {
        double most = -1e30;
        for (const glm::dvec4& facet : facets) most = std::max(most, glm::dot(glm::dvec3(facet), p) + facet.w);
        return most;
    }
    // Of a ray; the mesh is convex. Not negative where the ray meets it, however near its outline: more inside.
    double overlap(const glm::dvec3& origin, const glm::dvec3& direction) const {
        double enter = 0.0, leave = 1e30;
        for (const glm::dvec4& facet : facets) {
            const double slope = glm::dot(glm::dvec3(facet), direction),
                         height = glm::dot(glm::dvec3(facet), origin) + facet.w;
            if (slope > 0.0) leave = std::min(leave, -height / slope);
            if (slope < 0.0) enter = std::max(enter, -height / slope);
        }
        return leave - enter;
    }
    std::vector<glm::dvec4> facets;
};

// A count, and how many more or less it may be by rounding.
struct Counted {
    std::uint64_t certain = 0, open = 0;
    void add(double inside_by, double doubt) {
        certain += inside_by > doubt;
        open += std::abs(inside_by) <= doubt;
    }
};

void expect_count(std::uint64_t found, const Counted& expected, const std::string& what) {
    EXPECT_GE(found, expected.certain) << what;
    EXPECT_LE(found, expected.certain + expected.open) << what;
}

// Counted work: full screens shade every light at every pixel, volumes the pixels that they cover,
// stencilled ones those whose surface they hold; each against a count by rays and planes.
TEST(LightVolumeCount, FragmentsShadedAreThoseOfTheScreenTheVolumesAndWhatIsInThem) {
    // Both kinds of context rasterize alike: one is enough.
    GlContext& context = test_context(GlBackend::egl);
    const View view(corner_view().camera(), 48, 36);
    for (const int lights : {1, 16, 256, 1024}) {
        SCOPED_TRACE(testing::Message() << lights << " lights");
        Scene scene = make_layered_scene();
        add_lamps(scene, lights);
        const Frame frame = render(context, scene, view, {"position", "depth"}, lamp_method(LocalLights::fullscreen));
        const LightVolumes volumes(scene, 1.0f / 256.0f);
        ASSERT_EQ(volumes.point_spheres.size(), static_cast<std::size_t>(lights));
        const VolumeMesh mesh = enclosing_sphere(1);
        Counted covered, inside;
        for (const LightVolume& light : volumes.point_spheres) {
            const PlacedVolume volume(light, mesh);
            for (int y = 0; y < view.height(); ++y) {
                for (int x = 0; x < view.width(); ++x) {
                    const Ray ray = view.pixel_ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                    const glm::dvec3 direction = glm::normalize(glm::dvec3(ray.direction));
                    // The rasterizer's grid of 1/256 pixel shifts outlines by 0.4 mm here; where facets meet at 20
                    // degrees, a ray in the mesh is longer or shorter by ten times that, or a few times more.
                    covered.add(volume.overlap(glm::dvec3(ray.origin), direction), 0.02);
                    if (std::isinf(frame.plane("depth").at(x, y))) continue;
                    // And shifts facets by no more than those 0.4 mm.
                    inside.add(-volume.outside_by(vector_at(frame.plane("position"), x, y)), 1e-3);
                }
            }
        }
        LightRun volume(context, scene, lamp_method(LocalLights::volume), {"direct"}, view);
        LightRun stencil(context, scene, lamp_method(LocalLights::volume_stencil), {"direct"}, view);
        volume.run(), stencil.run();
        const std::uint64_t naive = count_light_fragments(context, scene, lamp_method(LocalLights::fullscreen), view);
        EXPECT_EQ(naive, std::uint64_t{48} * 36u * static_cast<std::uint64_t>(lights));
        expect_count(volume.fragments_shaded(), covered, "volumes");
        expect_count(stencil.fragments_shaded(), inside, "stencilled volumes");
        EXPECT_LT(inside.open, inside.certain / 20 + 10) << "the count by planes must tell something";
        EXPECT_LT(covered.open, covered.certain / 10 + 10);
        EXPECT_LE(stencil.fragments_shaded(), volume.fragments_shaded());
        if (lights > 1) {
            EXPECT_LT(volume.fragments_shaded(), naive);
            EXPECT_LT(stencil.fragments_shaded(), naive / 2);
        }
    }
}

}  // namespace
}  // namespace plumb
