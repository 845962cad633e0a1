// Specular lobes and thin transparency of imported materials.
#include <cmath>

#include <gmock/gmock.h>

#include "scenes/import.h"
#include "tests/scenes/small_files.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

Scene obj_scene(const std::string& mtl, bool specular = false) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl m\n" + mtl);
    ImportOptions options;
    options.specular = specular;
    return import_scene_file(folder.write("a.obj", std::string("mtllib a.mtl\nusemtl m\n") + triangle_obj), options);
}

Material obj_material(const std::string& mtl, bool specular = false) {
    const Scene scene = obj_scene(mtl, specular);
    return scene.materials[scene.meshes[0].material];
}

Material gltf_material(const std::string& text) {
    const TemporaryFolder folder;
    return import_scene_file(folder.write("a.gltf", gltf(text))).materials[0];
}

void expect_near(const glm::vec3& value, const glm::vec3& expected) {
    // A few roundings of numbers up to 1.
    EXPECT_LT(glm::distance(value, expected), 1e-6f) << value.x << " " << value.y << " " << value.z;
}

TEST(ImportMtl, DissolvedIsAThinSheet) {
    for (const char* mtl : {"Kd 0.4 0.8 0\nd 0.25\n", "Kd 0.4 0.8 0\nTr 0.75\n", "Kd 0.4 0.8 0\nd 0.25\nTf 1 1 1\n"}) {
        const Material material = obj_material(mtl);
        EXPECT_TRUE(material.is_transparent()) << mtl;
        expect_near(material.transmission, glm::vec3(0.75f));
        expect_near(material.base_colour, {0.1f, 0.2f, 0.0f});
    }
    const Scene scene = obj_scene("Kd 0 0 0\nd 0.1\n");
    EXPECT_THAT(scene.import_notes, Contains(AllOf(HasSubstr("transparent materials"), HasSubstr(": m"))));
    EXPECT_THAT(scene.import_notes.front(), HasSubstr("(0 glossy, 1 transparent)"));
}

TEST(ImportMtl, FilterColoursWhatADissolvedSheetPasses) {
    expect_near(obj_material("Kd 0 0 0\nd 0.5\nTf 1 0.5 0\n").transmission, {0.5f, 0.25f, 0.0f});
}

TEST(ImportMtl, FilterAloneMeansNothing) {
    for (const char* mtl : {"d 1\nTr 0\nTf 1 1 1\nillum 2\n", "Tf 1 1 1\n", "Tf 0.1 0.1 0.1\nillum 7\n", "d 0.999\n"}) {
        EXPECT_FALSE(obj_material(std::string("Kd 0.5 0.5 0.5\n") + mtl).is_transparent()) << mtl;
    }
}

TEST(ImportMtl, HighlightsAreLobesOnlyWhereAskedFor) {
    const std::string plastic = "Kd 0.5 0.5 0.5\nKs 0.2 0.4 0.6\nNs 30\nillum 2\n";
    EXPECT_FALSE(obj_material(plastic).has_specular_lobe());
    const Material material = obj_material(plastic, true);
    EXPECT_NEAR(material.dielectric_reflectance, 0.2126f * 0.2f + 0.7152f * 0.4f + 0.0722f * 0.6f, 1e-6f);
    EXPECT_NEAR(material.roughness * material.roughness, std::sqrt(2.0f / 32.0f), 1e-6f);
    EXPECT_EQ(material.metallic, 0.0f);
    expect_near(material.base_colour, glm::vec3(0.5f));
    EXPECT_FALSE(obj_material("Kd 0.5 0.5 0.5\nKs 0 0 0\nNs 30\n", true).has_specular_lobe());
    EXPECT_FALSE(obj_material("Kd 0.5 0.5 0.5\nKs 1 1 1\nillum 0\n", true).has_specular_lobe());
    EXPECT_EQ(obj_material("Kd 0.5 0.5 0.5\nKs 0.04 0.04 0.04\nNs 1000\n", true).roughness, 0.0f);
}

TEST(ImportMtl, MirrorsAreMetals) {
    const std::string mirror = "Kd 0.01 0.01 0.01\nKs 0.95 0.9 0.85\nNs 1000\nillum 5\n";
    EXPECT_FALSE(obj_material(mirror).has_specular_lobe());
    const Material material = obj_material(mirror, true);
    EXPECT_EQ(material.metallic, 1.0f);
    EXPECT_EQ(material.roughness, 0.0f);
    expect_near(material.base_colour, {0.95f, 0.9f, 0.85f});
    // Painted and a little reflecting is no mirror.
    const Material paint = obj_material("Kd 0.5 0.5 0.5\nKs 0.1 0.1 0.1\nNs 50\nillum 3\n", true);
    EXPECT_EQ(paint.metallic, 0.0f);
    EXPECT_NEAR(paint.dielectric_reflectance, 0.1f, 1e-6f);
    EXPECT_EQ(paint.roughness, 0.0f);
}

TEST(ImportMtl, BlackWithHighlightIsAMetalUnlessTransparent) {
    EXPECT_EQ(obj_material("Kd 0 0 0\nKs 0.9 0.9 0.9\nNs 100\n").metallic, 1.0f);
    const Material glass = obj_material("Kd 0 0 0\nKs 1 1 1\nNs 1000\nNi 1.5\nd 0.1\nTf 1 1 1\n", true);
    EXPECT_EQ(glass.metallic, 0.0f);
    EXPECT_NEAR(glass.dielectric_reflectance, 0.04f, 1e-6f);  // ((1.5 - 1) / (1.5 + 1))^2
    expect_near(glass.transmission, glm::vec3(0.9f));
}

TEST(ImportGltf, DielectricsReflectAsTheirIndexAndSpecularFactorSay) {
    EXPECT_NEAR(gltf_material(R"("name":"m")").dielectric_reflectance, 0.04f, 1e-7f);
    const auto extensions = [](const std::string& text) {
        return gltf_material(R"("extensions":{)" + text + "}").dielectric_reflectance;
    };
    // Water: (0.33 / 2.33)^2.
    EXPECT_NEAR(extensions(R"("KHR_materials_ior":{"ior":1.33})"), 0.0200593f, 1e-6f);
    EXPECT_NEAR(extensions(R"("KHR_materials_specular":{"specularFactor":0.5})"), 0.02f, 1e-6f);
    EXPECT_NEAR(extensions(R"("KHR_materials_specular":{"specularColorFactor":[0,1,0]})"), 0.04f * 0.7152f, 1e-6f);
    EXPECT_EQ(extensions(R"("KHR_materials_specular":{"specularFactor":0})"), 0.0f);
}

TEST(ImportGltf, BlendedIsAThinSheetThatCoversItsAlpha) {
    const Material pane = gltf_material(
        R"("alphaMode":"BLEND","emissiveFactor":[1,1,1],"pbrMetallicRoughness":{"baseColorFactor":[0.8,0.4,0.2,0.25],"metallicFactor":0})");
    expect_near(pane.transmission, glm::vec3(0.75f));
    expect_near(pane.base_colour, {0.2f, 0.1f, 0.05f});
    expect_near(pane.emission, glm::vec3(0.25f));
    EXPECT_FALSE(pane.alpha_mask);
}

TEST(ImportGltf, TransmissionPassesTheBaseColourOfItsDielectricPart) {
    const std::string factor =
        R"("extensions":{"KHR_materials_transmission":{"transmissionFactor":0.6}},"pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0,1],"metallicFactor":)";
    const Material glass = gltf_material(factor + "0}");
    expect_near(glass.transmission, {0.6f, 0.3f, 0.0f});
    expect_near(glass.base_colour, {0.4f, 0.2f, 0.0f});
    const Material metal = gltf_material(factor + "1}");
    EXPECT_FALSE(metal.is_transparent());
    expect_near(metal.base_colour, {1.0f, 0.5f, 0.0f});
}

// Two grey texels of the given alpha: uncompressed Targa with 32 bits per texel.
std::string targa(unsigned char first_alpha, unsigned char second_alpha) {
    std::string image("\0\0\2\0\0\0\0\0\0\0\0\0\2\0\1\0\x20\x08", 18);
    for (const unsigned char alpha : {first_alpha, second_alpha})
        image += std::string(3, '\x80') + static_cast<char>(alpha);
    return image;
}

Scene blended_image(unsigned char first_alpha, unsigned char second_alpha) {
    const TemporaryFolder folder;
    folder.write("pane.tga", targa(first_alpha, second_alpha));
    // Closes the material's braces, so that the image can follow; gltf() closes the extras.
    return import_scene_file(folder.write(
        "a.gltf",
        gltf(
            R"("alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicFactor":0}}],"textures":[{"source":0}],"images":[{"uri":"pane.tga"}],"extras":[{"x":0)")));
}

TEST(ImportGltf, AnImageOfAlphaIsAMaskWithHolesAndAPaneWithout) {
    const Scene leaf = blended_image(0, 255);
    EXPECT_TRUE(leaf.materials[0].alpha_mask);
    EXPECT_FALSE(leaf.materials[0].is_transparent());
    EXPECT_THAT(leaf.import_notes, Contains(HasSubstr("mask at alpha 0.5")));
    const Scene lens = blended_image(51, 153);  // alpha 0.2 and 0.6
    EXPECT_FALSE(lens.materials[0].alpha_mask);
    // Texels are half floats: 0.2 and 0.6 are off by up to 2.5e-4.
    EXPECT_NEAR(lens.materials[0].transmission.x, 0.6f, 3e-4f);
    const Scene solid = blended_image(255, 255);
    EXPECT_FALSE(solid.materials[0].alpha_mask);
    EXPECT_FALSE(solid.materials[0].is_transparent());
}

TEST(Import, KeepsApartWhatIsToMove) {
    const TemporaryFolder folder;
    const auto file =
        folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng box\nf 1 2 3\ng lid\nf 1 2 4\ng base\nf 1 3 4\n");
    EXPECT_EQ(import_scene_file(file).instances.size(), 1u);
    ImportOptions options;
    options.keep_apart = {"lid"};
    const Scene scene = import_scene_file(file, options);
    ASSERT_EQ(scene.instances.size(), 2u);
    EXPECT_EQ(scene.triangle_count(), 3u);
    EXPECT_EQ(scene.instances[0].name, "lid");
}

}  // namespace
}  // namespace plumb
