// The material rules and lamps of the scene model, and what is refused of them.
#include <functional>

#include <gmock/gmock.h>

#include "scenes/builtin.h"
#include "scenes/scene.h"
#include "scenes/scene_error.h"
#include "scenes/validate.h"
#include "tests/message_of.h"

namespace plumb {
namespace {

using testing::HasSubstr;

SurfaceSample sample_of(float metallic, float dielectric_reflectance) {
    Material material;
    material.base_colour = {0.2f, 0.4f, 0.8f};
    material.metallic = metallic;
    material.dielectric_reflectance = dielectric_reflectance;
    EXPECT_EQ(material.has_specular_lobe(), metallic > 0.0f || dielectric_reflectance > 0.0f);
    return Scene().surface(material, {});
}

TEST(SurfaceSample, HasNoSpecularLobeWithoutMetalOrReflectance) {
    const SurfaceSample sample = sample_of(0.0f, 0.0f);
    EXPECT_EQ(sample.specular_f0, glm::vec3(0.0f));
    EXPECT_EQ(sample.specular_f90, glm::vec3(0.0f));
    EXPECT_EQ(sample.albedo, sample.base_colour);
}

TEST(SurfaceSample, MixesDielectricAndMetalAsGltfDoes) {
    const SurfaceSample plastic = sample_of(0.0f, 0.04f);
    EXPECT_EQ(plastic.specular_f0, glm::vec3(0.04f));
    EXPECT_EQ(plastic.specular_f90, glm::vec3(1.0f));
    const SurfaceSample metal = sample_of(1.0f, 0.04f);
    EXPECT_EQ(metal.specular_f0, glm::vec3(0.2f, 0.4f, 0.8f));
    EXPECT_EQ(metal.specular_f90, glm::vec3(1.0f));
    EXPECT_EQ(metal.albedo, glm::vec3(0.0f));
    const SurfaceSample half = sample_of(0.5f, 0.04f);
    EXPECT_NEAR(half.specular_f0.z, 0.5f * 0.04f + 0.5f * 0.8f, 1e-7f);
    EXPECT_EQ(half.specular_f90, glm::vec3(1.0f));
}

TEST(SurfaceSample, PartlyMetallicWithoutDielectricLobeHasThatShareOfAMetals) {
    const SurfaceSample sample = sample_of(0.25f, 0.0f);
    EXPECT_NEAR(sample.specular_f0.y, 0.25f * 0.4f, 1e-7f);
    EXPECT_EQ(sample.specular_f90, glm::vec3(0.25f));
    EXPECT_NEAR(sample.albedo.y, 0.75f * 0.4f, 1e-7f);
}

TEST(SurfaceSample, AMetallicTextureTakesTheLobeAway) {
    Scene scene;
    Texture texture;
    texture.width = texture.height = 1;
    texture.texels = {half(1.0f), half(0.5f), half(0.0f), half(1.0f)};  // roughness 0.5, metallic 0
    scene.textures = {texture};
    Material material;
    material.metallic = 1.0f;
    material.metallic_roughness_texture = 0;
    EXPECT_TRUE(material.has_specular_lobe());
    const SurfaceSample sample = scene.surface(material, {0.5f, 0.5f});
    EXPECT_EQ(sample.specular_f0, glm::vec3(0.0f));
    EXPECT_EQ(sample.specular_f90, glm::vec3(0.0f));
    EXPECT_FLOAT_EQ(sample.roughness, 0.5f);
}

TEST(Attenuation, OfTheDefaultIsTheInverseSquareToTheBit) {
    const Attenuation vacuum;
    EXPECT_TRUE(vacuum.is_inverse_square());
    for (const float d : {0.001f, 0.3f, 1.7f, 123.0f}) {
        EXPECT_EQ(vacuum.divisor(d, d * d), d * d);
        EXPECT_EQ(vacuum.evaluate(d), 1.0f / (d * d));
    }
    const Attenuation terms{1.0f, 0.5f, 0.25f};
    EXPECT_FALSE(terms.is_inverse_square());
    EXPECT_FLOAT_EQ(terms.evaluate(2.0f), 1.0f / 3.0f);
}

TEST(Validate, RefusesWhatNoSurfaceOrLampCanHave) {
    using Change = std::function<void(Scene&)>;
    const std::vector<std::pair<Change, const char*>> cases = {
        {[](Scene& s) { s.materials[0].dielectric_reflectance = 1.5f; }, "dielectric reflectance (1.5"},
        {[](Scene& s) { s.materials[0].transmission.z = -0.5f; }, "transmission (0, 0, -0.5)"},
        {[](Scene& s) { s.materials[0].transmission.x = 0.9f; }, "more light would leave than arrives"},
        {[](Scene& s) {
             s.point_lights[0].attenuation = {0, 0, 0};
         },
         "point light 'lamp': attenuation"},
        {[](Scene& s) { s.point_lights[0].attenuation.linear = -1; }, "terms 0, -1 and 1"},
        {[](Scene& s) { s.spot_lights[0].attenuation.constant = std::nanf(""); }, "spot light 'spot': attenuation"},
        {[](Scene& s) { s.directional_lights[0].angular_radius = 1.6f; }, "angular radius 1.6"},
        {[](Scene& s) { s.directional_lights[0].angular_radius = -0.1f; }, "angular radius -0.1"},
        {[](Scene& s) {
             s.instances[0].motion.keys = {{.time = 1.0f}, {.time = 1.0f}};
         },
         "instance 'floor': motion: key 1"},
    };
    for (const auto& [change, wanted] : cases) {
        Scene scene = make_cornell();
        PointLight lamp;
        lamp.name = "lamp";
        SpotLight spot;
        spot.name = "spot";
        scene.point_lights = {lamp};
        scene.spot_lights = {spot};
        scene.directional_lights = {DirectionalLight{}};
        EXPECT_NO_THROW(validate(scene));
        change(scene);
        EXPECT_THAT(message_of<SceneError>([&, &s = scene] { validate(s); }), HasSubstr(wanted));
    }
}

}  // namespace
}  // namespace plumb
