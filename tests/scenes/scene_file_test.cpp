#include "scenes/scene_file.h"

#include <algorithm>
#include <cstdlib>

#include <gmock/gmock.h>

#include "scenes/builtin.h"
#include "scenes/effects.h"
#include "scenes/scene_error.h"
#include "tests/message_of.h"
#include "tests/scenes/small_files.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

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

TEST(SceneFile, ReadsLobesLampsLensesAndMotions) {
    const TemporaryFolder folder;
    folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng box\nf 1 2 3\ng lid\nf 1 2 4\n");
    const auto file = folder.write("a.toml", R"(
mesh = "a.obj"
[materials.DefaultMaterial]
base_colour = 0.2
dielectric_reflectance = 0.05
transmission = [0.7, 0.6, 0.5]
[[point_lights]]
position = [0, 5, 0]
intensity = 3
attenuation = { constant = 1, linear = 0.5, quadratic = 0.25 }
[[spot_lights]]
position = [0, 4, 0]
intensity = 1
attenuation = { constant = 0, linear = 2, quadratic = 0 }
[[directional_lights]]
irradiance = 5
angular_radius = 0.5
[[views]]
name = "lens"
eye = [0, 0, 5]
target = [0, 0, 1]
aperture_radius = 0.02
[[views]]
name = "far"
eye = [0, 0, 5]
target = [0, 0, 1]
aperture_radius = 0.02
focus_distance = 9
[[paths]]
name = "go"
aperture_radius = 0.03
keys = [{ time = 0, eye = [0, 0, 5], target = [0, 0, 0] }]
[[motions]]
instance = "lid"
interpolation = "linear"
pivot = [1, 0, 0]
keys = [{ time = -1 }, { time = 1, translation = [0, 2, 0], axis = [0, 0, 5], angle = 180, scale = 4 }]
)");
    const Scene scene = load_scene(file.string());
    const Material& material = scene.materials[scene.meshes[0].material];
    EXPECT_EQ(material.dielectric_reflectance, 0.05f);
    EXPECT_EQ(material.transmission, glm::vec3(0.7f, 0.6f, 0.5f));
    EXPECT_FLOAT_EQ(scene.point_lights.at(0).attenuation.evaluate(2.0f), 1.0f / 3.0f);
    EXPECT_FLOAT_EQ(scene.spot_lights.at(0).attenuation.evaluate(4.0f), 0.125f);
    EXPECT_FLOAT_EQ(scene.directional_lights.at(0).angular_radius, glm::radians(0.5f));
    EXPECT_EQ(scene.camera("lens").aperture_radius, 0.02f);
    EXPECT_FLOAT_EQ(scene.camera("lens").focus_distance, 4.0f);
    EXPECT_EQ(scene.camera("far").focus_distance, 9.0f);
    EXPECT_EQ(scene.path("go").at(0.0f).aperture_radius, 0.03f);
    EXPECT_FLOAT_EQ(scene.path("go").at(0.0f).focus_distance, 5.0f);
    const auto lid = std::ranges::find(scene.instances, std::string("lid"), &Instance::name);
    ASSERT_NE(lid, scene.instances.end());
    // At time 0 half the way: up by 1, a quarter turn about +Z through (1, 0, 0), twice the size. The origin, 1 left of
    // the pivot, comes to 2 below it.
    const glm::vec3 origin(lid->world_from_object[3]);
    EXPECT_LT(glm::distance(origin, glm::vec3(1, -1, 0)), 1e-5f) << origin.x << " " << origin.y << " " << origin.z;
    EXPECT_EQ(lid->world_from_object, lid->pose(0.0));
    const EffectPlan plan = plan_effects(scene);
    for (const EffectKind kind : {EffectKind::glossy_surfaces, EffectKind::transparency, EffectKind::moving_objects,
                                  EffectKind::lens, EffectKind::attenuation, EffectKind::sun_discs}) {
        EXPECT_TRUE(plan.on(kind)) << to_string(kind);
    }
    EXPECT_THAT(plan[EffectKind::moving_objects].reason, HasSubstr("lid"));
    EXPECT_THAT(plan[EffectKind::lens].reason, HasSubstr("lens, far, go"));
}

TEST(SceneFile, WithoutAPivotAMotionTurnsAboutTheCentreOfWhatMoves) {
    const TemporaryFolder folder;
    const auto file = folder.write("a.toml", R"(
builtin = "cornell"
[[motions]]
instance = "short block"
keys = [{ time = 0 }, { time = 1, axis = [0, 1, 0], angle = 180 }]
)");
    Scene scene = load_scene(file.string());
    const auto block = std::ranges::find(scene.instances, std::string("short block"), &Instance::name);
    ASSERT_NE(block, scene.instances.end());
    const glm::vec3 centre = scene.bounds(*block).centre();
    EXPECT_EQ(block->world_from_object, glm::mat4(1.0f));
    scene.move_to(1.0);
    EXPECT_LT(glm::distance(scene.bounds(*block).centre(), centre), 1e-6f);  // float rounding within half a metre
    EXPECT_NE(block->world_from_object, glm::mat4(1.0f));
}

TEST(SceneFile, FindsMeshesInTheSceneFolders) {
    const TemporaryFolder folder;
    folder.write("elsewhere/sub/a.obj", triangle_obj);
    const auto file = folder.write("a.toml", "mesh = \"sub/a.obj\"\n");
    EXPECT_EQ(load_scene(file.string(), {folder.path / "elsewhere"}).triangle_count(), 1u);
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
        {"builtin = \"cornell\"\n[materials.white]\ntransmission = 0.5\n", "more light would leave"},
        {"builtin = \"cornell\"\n[[point_lights]]\nposition = 0\nintensity = 1\nattenuation = { linear = 1 }\n",
         "bad.toml:5: [attenuation] needs a key 'constant'"},
        {"builtin = \"cornell\"\n[[motions]]\ninstance = \"lid\"\nkeys = [{ time = 0 }]\n",
         "bad.toml:3: [[motions]] names an instance 'lid' that the scene does not have"},
        {"builtin = \"cornell\"\n[[motions]]\ninstance = \"floor\"\nkeys = []\n", "[[motions]] has no keys"},
        {"builtin = \"cornell\"\n[[motions]]\ninstance = \"floor\"\nkeys = [{ time = 0 }, { time = 0 }]\n",
         "bad.toml:4: [[motions]] is no motion: motion: key 1 at 0 s does not come after key 0"},
        {"builtin = \"cornell\"\n[[motions]]\ninstance = \"floor\"\nkeys = [{ time = 0, angle = 90 }]\n",
         "no axis to turn about"},
        {"builtin = \"cornell\"\n[[motions]]\ninstance = \"floor\"\nkeys = [{ time = 0 }, { time = 1, axis = [0, 1, "
         "0], "
         "angle = 720 }]\n",
         "turns from 0 to 720 degrees at once"},
        {"builtin = \"cornell\"\n[[motions]]\ninstance = \"floor\"\ninterpolation = \"cubic\"\nkeys = []\n",
         "must be 'smooth' or 'linear'"},
        {"builtin = \"cornell\"\n[[motions]]\ninstance = \"floor\"\nkeys = [{ time = 0 }]\n[[motions]]\ninstance = "
         "\"floor\"\nkeys = [{ time = 0 }]\n",
         "moves 'floor' once more"},
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
