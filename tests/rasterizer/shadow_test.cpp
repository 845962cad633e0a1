// Shadows of every kind of light against rays, and the lighting of the second layer.
#include "gl_test.h"
#include "scenes/builtin.h"
#include "shadow_rays.h"

namespace plumb {
namespace {

using ShadowTest = GlTest;
PLUMBLINE_BOTH_BACKENDS(ShadowTest);

// Texels measure a few millimetres here; three of them are the reach of bilinear filtering and of the lift.
TEST_P(ShadowTest, PointLightShadowsAreWhereRaysSay) {
    Scene scene = make_shadow_scene();
    scene.point_lights.push_back({"lamp", {0.4f, 1.9f, 0.9f}, {9.0f, 7.0f, 5.0f}});
    expect_shadows(context(), scene, near_view(), glm::dvec3(scene.point_lights[0].position), false, -1, 0.03);
}

TEST_P(ShadowTest, SpotLightShadowsAreWhereRaysSay) {
    for (const float outer : {1.05f, 1.5f}) {  // a flat map, a cube
        Scene scene = make_shadow_scene();
        scene.spot_lights.push_back(
            {"spot", {0.4f, 2.6f, 0.9f}, glm::normalize(glm::vec3(-0.3f, -1.0f, -0.5f)), {9, 7, 5}, 0.5f, outer});
        expect_shadows(context(), scene, near_view(), glm::dvec3(scene.spot_lights[0].position), false, -1, 0.03);
    }
}

TEST_P(ShadowTest, DirectionalShadowsAreWhereRaysSay) {
    Scene scene = make_shadow_scene();
    scene.directional_lights.push_back({"sun", glm::normalize(glm::vec3(-0.4f, -1.0f, -0.6f)), {3, 2, 1}});
    expect_shadows(context(), scene, near_view(), glm::dvec3(scene.directional_lights[0].direction), true, -1, 0.03);
}

TEST_P(ShadowTest, EmitterCastsTheShadowOfItsCentreAndNoneOfItsOwn) {
    const Scene scene = make_cornell();
    const glm::dvec3 centre(0.278, 0.5483, 0.2795);
    const View view(scene.cameras[0], 80, 80);
    expect_shadows(context(), scene, view, centre, false, 5, 0.012);
}

TEST_P(ShadowTest, MoreSamplePointsSoftenTheShadow) {
    const Scene scene = make_cornell();
    const View view(scene.cameras[0], 64, 64);
    const auto levels = [&](int samples) {
        Method method = plain_method();
        method.direct.shadow.emitter_samples = samples;
        method.direct.shadow.emitter_size = 256;
        return render(context(), scene, view, {"direct"}, method).plane("direct");
    };
    const Image hard = levels(1), soft = levels(16);
    int partly = 0;
    double hard_sum = 0.0, soft_sum = 0.0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            hard_sum += hard.at(x, y), soft_sum += soft.at(x, y);
            partly +=
                hard.at(x, y) > 0.0f && soft.at(x, y) < 0.9f * hard.at(x, y) && soft.at(x, y) > 0.1f * hard.at(x, y);
        }
    }
    EXPECT_GT(partly, 20);
    // A penumbra takes about as much as it gives.
    EXPECT_NEAR(soft_sum / hard_sum, 1.0, 0.1);
}

TEST_P(ShadowTest, MaskedHolesLetLightThrough) {
    Scene scene = make_corner();
    Texture stripes;
    stripes.width = 4, stripes.height = 1, stripes.wrap_u = stripes.wrap_v = TextureWrap::clamp;
    for (int x = 0; x < 4; ++x) {
        for (int k = 0; k < 4; ++k) stripes.texels.push_back(half(x < 2 ? 1.0f : 0.0f));
    }
    scene.textures.push_back(stripes);
    Material mask;
    mask.alpha_mask = true;
    mask.base_colour_texture = 0;
    scene.materials.push_back(mask);
    add_quad(scene, 2, {-0.8f, 0.7f, 0.6f}, {1.4f, 0, 0}, {0, 0, -1.2f});
    scene.meshes.back().uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    scene.point_lights.push_back({"lamp", {0.1f, 2.4f, 0.3f}, {9.0f, 7.0f, 5.0f}});
    expect_shadows(context(), scene, near_view(), glm::dvec3(scene.point_lights[0].position), false, -1, 0.03);
}

TEST_P(ShadowTest, SecondLayerIsLitAsTheFirstWouldBe) {
    // The same wall seen freely and through a pane: its light must not depend on the layer that holds it.
    Scene scene = make_corner();
    scene.point_lights.push_back({"lamp", {-0.3f, 1.5f, 0.2f}, {9.0f, 7.0f, 5.0f}});
    const View view = corner_view();
    const Frame free = render(context(), scene, view, {"direct"}, plain_method());
    Scene behind = scene;
    // Close to the camera, hides the whole view, and too far from the lamp's side to shade anything that is seen.
    const glm::mat4& camera = view.camera().world_from_camera;
    const auto world = [&](float x, float y, float z) { return glm::vec3(camera * glm::vec4(x, y, z, 1.0f)); };
    add_quad(behind, 0, world(-0.4f, -0.4f, -0.3f), world(0.4f, -0.4f, -0.3f) - world(-0.4f, -0.4f, -0.3f),
             world(-0.4f, 0.4f, -0.3f) - world(-0.4f, -0.4f, -0.3f));
    const Frame hidden = render(context(), behind, view, {"layer2.direct"}, plain_method());
    int different = 0;
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            const glm::dvec3 a = vector_at(free.plane("direct"), x, y),
                             b = vector_at(hidden.plane("layer2.direct"), x, y);
            different += glm::length(a - b) > 2e-3 * glm::length(a);
        }
    }
    EXPECT_EQ(different, 0);
}

}  // namespace
}  // namespace plumb
