#include "scenes/scene_file.h"

#include <cstdlib>

#include <gmock/gmock.h>

#include "scenes/builtin.h"
#include "scenes/effects.h"
#include "scenes/scene_error.h"
#include "tests/scenes/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

const char* const triangle_obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST(SceneFile, WrapsAMeshWithLightsViewsAndPaths) {
    const TemporaryFolder folder;
    folder.write("meshes/a.obj", std::string("mtllib a.mtl\nusemtl paint\n") + triangle_obj);
    folder.write("meshes/a.mtl", "newmtl paint\nKd 0.5 0.5 0.5\n");
    const auto file = folder.write("wrapped.toml", R"(
mesh = "meshes/a.obj"
description = "one triangle"
[import]
scale = 2.0
[materials.paint]
base_colour = [0.1, 0.2, 0.3]
emission = 2.0
two_sided = false
[ground]
height = -1.0
[environment]
radiance = [1, 2, 3]
rotation = 90.0
[[point_lights]]
name = "lamp"
position = [0, 5, 0]
intensity = 3
[[spot_lights]]
position = [0, 4, 0]
target = [0, 0, 0]
intensity = [1, 1, 1]
outer_angle = 30.0
[[directional_lights]]
direction = [0, -2, 0]
irradiance = 5
[[views]]
name = "front"
eye = [0, 0, 5]
target = [0, 0, 0]
vertical_fov = 60
near = 0.5
far = 9
[[paths]]
name = "go"
keys = [{ time = 0, eye = [0, 0, 5], target = [0, 0, 0] }, { time = 2, eye = [1, 0, 5], target = [0, 0, 0] }]
)");
    const Scene scene = load_scene(file.string());
    EXPECT_EQ(scene.name, "wrapped");
    EXPECT_EQ(scene.description, "one triangle");
    EXPECT_FLOAT_EQ(scene.bounds().upper.y, 2.0f);
    EXPECT_FLOAT_EQ(scene.bounds().lower.y, -1.0f);
    const Material& paint = scene.materials[scene.meshes[0].material];
    EXPECT_EQ(paint.base_colour, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(paint.emission, glm::vec3(2.0f));
    EXPECT_FALSE(paint.two_sided);
    EXPECT_EQ(scene.environment.radiance, glm::vec3(1, 2, 3));
    EXPECT_FLOAT_EQ(scene.environment.rotation, glm::radians(90.0f));
    EXPECT_EQ(scene.point_lights.at(0).intensity, glm::vec3(3));
    EXPECT_EQ(scene.spot_lights.at(0).direction, glm::vec3(0, -1, 0));
    EXPECT_FLOAT_EQ(scene.spot_lights.at(0).outer_angle, glm::radians(30.0f));
    EXPECT_EQ(scene.directional_lights.at(0).direction, glm::vec3(0, -1, 0));
    EXPECT_FLOAT_EQ(scene.camera("front").near_plane, 0.5f);
    EXPECT_FLOAT_EQ(scene.camera("front").vertical_fov, glm::radians(60.0f));
    EXPECT_FLOAT_EQ(scene.path("go").duration(), 2.0f);
}

TEST(SceneFile, FindsMeshesInTheSceneFolders) {
    const TemporaryFolder folder;
    folder.write("elsewhere/sub/a.obj", triangle_obj);
    const auto file = folder.write("a.toml", "mesh = \"sub/a.obj\"\n");
    EXPECT_EQ(load_scene(file.string(), {folder.path() / "elsewhere"}).triangle_count(), 1u);
    EXPECT_THAT(message_of<SceneError>([&] { load_scene(file.string()); }),
                AllOf(HasSubstr("sub/a.obj"), HasSubstr("--scenes-dir")));
}

TEST(SceneFile, AMeshAloneGetsAViewAndLightAndSaysSo) {
    const TemporaryFolder folder;
    const Scene scene = load_scene(folder.write("a.obj", triangle_obj).string());
    EXPECT_EQ(scene.cameras.size(), 1u);
    EXPECT_FALSE(scene.environment.is_black());
    EXPECT_THAT(scene.import_notes, Contains(HasSubstr("no light")));
    EXPECT_THAT(scene.import_notes, Contains(HasSubstr("no view")));
    const glm::vec3 seen = View(scene.cameras[0], 10, 10).project({0.3f, 0.3f, 0.0f});
    EXPECT_GT(seen.z, scene.cameras[0].near_plane);
}

struct BadToml {
    const char* text;
    const char* wanted;  // what the message must hold
};

TEST(SceneFile, ErrorsNameFileLineAndRemedy) {
    const BadToml cases[] = {
        {"builtin = \"cornell\"\n[import]\nscal = 2\n",
         "bad.toml:3: [import] has no key 'scal'; did you mean 'scale'?"},
        {"builtin = \"cornell\"\ncolour = 1\n", "bad.toml:2"},
        {"builtin = \"cornell\"\n\n[[views]]\nname = \"a\"\neye = [0, 0, 0]\n", "needs a key 'target'"},
        {"builtin = \"cornell\"\n[[views]]\nname = \"a\"\neye = [0, 0]\ntarget = [0, 0, 1]\n", "bad.toml:4"},
        {"builtin = \"cornell\"\n[[views]]\nname = \"a\"\neye = [0, 0, 1]\ntarget = [0, 0, 1]\n", "coincide"},
        {"builtin = \"cornell\"\n[materials.wite]\nroughness = 0.5\n", "it has: white, red, green, light"},
        {"builtin = \"cornell\"\n[materials.white]\nroughness = 2\n", "roughness 2"},
        {"builtin = \"cornell\"\n[[point_lights]]\nposition = [0, 0, 0]\nintensity = \"much\"\n", "bad.toml:4"},
        {"builtin = \"cornell\"\n[environment]\nimage = \"sky.hdr\"\n", "'sky.hdr' not found"},
        {"builtin = \"cornell\"\n[import]\nnormals = \"flat\"\n", "'file', 'face' or 'smooth'"},
        {"builtin = \"cornell\"\nmesh = \"a.obj\"\n", "either mesh"},
        {"name = \"nothing\"\n", "either mesh"},
        {"mesh = \n", "bad.toml:1"},
        {"builtin = \"cornell\"\n[[paths]]\nname = \"p\"\nkeys = []\n", "no keys"},
    };
    const TemporaryFolder folder;
    for (const BadToml& bad : cases) {
        const auto file = folder.write("bad.toml", bad.text);
        EXPECT_THAT(message_of<SceneError>([&] { load_scene(file.string()); }), HasSubstr(bad.wanted)) << bad.text;
    }
}

TEST(SceneFile, AnUnknownSceneListsTheOnesThereAre) {
    EXPECT_THAT(message_of<SceneError>([] { load_scene("corneli"); }),
                AllOf(HasSubstr("did you mean 'cornell'"), HasSubstr("crytek-sponza")));
}

TEST(SceneFile, EveryWrapperIsListedAndBuiltIn) {
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(PLUMBLINE_SOURCE_DIR "/scenes/wrappers")) {
        EXPECT_THAT(wrapper_scene_names(), Contains(entry.path().stem().string()));
        ++files;
    }
    EXPECT_EQ(files, wrapper_scene_names().size());
}

TEST(Effects, OfTheCornellBoxAreItsLightAndNothingElse) {
    const EffectPlan plan = plan_effects(make_cornell());
    EXPECT_TRUE(plan.on(EffectKind::emissive_surfaces));
    EXPECT_TRUE(plan.on(EffectKind::one_sided_surfaces));
    EXPECT_THAT(plan[EffectKind::emissive_surfaces].reason, HasSubstr("light"));
    for (const EffectKind kind : {EffectKind::point_lights, EffectKind::environment, EffectKind::alpha_masks,
                                  EffectKind::textures, EffectKind::glossy_surfaces, EffectKind::moving_objects}) {
        EXPECT_FALSE(plan.on(kind)) << to_string(kind);
        EXPECT_FALSE(plan[kind].reason.empty());
    }
}

TEST(Effects, OfTheColonnadeAreSunSkyLampMasksAndTextures) {
    const EffectPlan plan = plan_effects(make_colonnade());
    for (const EffectKind kind : {EffectKind::point_lights, EffectKind::directional_lights, EffectKind::environment,
                                  EffectKind::alpha_masks, EffectKind::textures}) {
        EXPECT_TRUE(plan.on(kind)) << to_string(kind);
    }
    EXPECT_FALSE(plan.on(EffectKind::emissive_surfaces));
    for (std::size_t i = 0; i < plan.effects.size(); ++i) EXPECT_EQ(static_cast<std::size_t>(plan.effects[i].kind), i);
}

TEST(Effects, IgnoreMaterialsThatNothingUses) {
    Scene scene = make_cornell();
    Material glossy;
    glossy.roughness = 0.1f;
    scene.materials.push_back(glossy);
    EXPECT_FALSE(plan_effects(scene).on(EffectKind::glossy_surfaces));
}

}  // namespace
}  // namespace plumb
