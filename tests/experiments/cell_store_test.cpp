#include "experiments/cell_store.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

namespace plumb {
namespace {

PlaneImage image_of(const std::string& method, float value) {
    PlaneImage image{"front", "ao", method, Image(5, 3, 1)};
    for (float& v : image.image.values()) v = value;
    image.image.values()[0] = 1.0f / 3.0f;
    image.timing = {1.5, 1.25, 1.75, 7, {{"gbuffer", 0.5}, {"ao", 1.0}}};
    image.gbuffer_bytes_per_pixel = 12;
    return image;
}

TEST(CellStore, GivesBackEveryBitOfWhatItKept) {
    const TemporaryFolder folder;
    PlaneImage oracle = image_of("oracle, 2 layers", 0.25f);
    oracle.oracle = {.layers = 2, .bounces = 3};
    oracle.halves = {Image(5, 3, 1), Image(5, 3, 1)};
    oracle.halves->b.values()[4] = 0.1f;
    PlaneImage with_seeds = image_of("one", 0.5f);
    with_seeds.other_seeds = {Image(5, 3, 1, 0.75f), Image(5, 3, 1, 0.125f)};
    CellStore(folder.path / "cells").save("a key", {with_seeds, oracle});

    const auto kept = CellStore(folder.path / "cells").load("a key");
    ASSERT_TRUE(kept);
    ASSERT_EQ(kept->size(), 2u);
    const PlaneImage &one = kept->front(), &two = kept->back();
    EXPECT_EQ(one.method, "one");
    EXPECT_EQ(one.image.values()[0], 1.0f / 3.0f);
    EXPECT_EQ(one.timing.median, 1.5);
    EXPECT_EQ(one.timing.repetitions, 7);
    ASSERT_EQ(one.timing.passes.size(), 2u);
    EXPECT_EQ(one.timing.passes[1].pass, "ao");
    EXPECT_EQ(one.gbuffer_bytes_per_pixel, 12);
    EXPECT_FALSE(one.oracle.any());
    EXPECT_FALSE(one.halves);
    ASSERT_EQ(one.other_seeds.size(), 2u);
    EXPECT_EQ(one.other_seeds[0].values()[7], 0.75f);
    EXPECT_EQ(one.other_seeds[1].values()[7], 0.125f);
    EXPECT_TRUE(two.other_seeds.empty());
    EXPECT_EQ(two.oracle.layers, 2);
    EXPECT_EQ(two.oracle.bounces, 3);
    ASSERT_TRUE(two.halves);
    EXPECT_EQ(two.halves->b.values()[4], 0.1f);
}

TEST(CellStore, KnowsNothingOfOtherKeysAndOfDamagedCells) {
    const TemporaryFolder folder;
    const CellStore store(folder.path / "cells");
    EXPECT_FALSE(store.load("a key"));
    store.save("a key", {image_of("one", 0.5f)});
    EXPECT_FALSE(store.load("another key"));
    EXPECT_TRUE(store.load("a key"));
    for (const auto& entry : std::filesystem::directory_iterator(folder.path / "cells"))
        std::filesystem::resize_file(entry.path(), 200);
    EXPECT_FALSE(store.load("a key")) << "a cell that was cut off is rendered again";
    store.clear();
    EXPECT_FALSE(std::filesystem::exists(folder.path / "cells"));
}

}  // namespace
}  // namespace plumb
