#include "experiments/config.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/message_of.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(Config, TextThatIsNotTomlIsReportedWithFileAndLine) {
    const std::string message = message_of<ConfigError>([] { parse_config("a = 1\nb = = 2\n", "broken.toml"); });
    EXPECT_THAT(message, AllOf(HasSubstr("broken.toml:2"), HasSubstr("not valid TOML")));
}

TEST(Config, AMissingFileIsNamed) {
    const std::string message = message_of<ConfigError>([] { read_config("no/such/file.toml"); });
    EXPECT_THAT(message, HasSubstr("'no/such/file.toml'"));
}

TEST(Config, AnUnknownKeyIsReportedWithItsLineAndTheNearestKnownOne) {
    const ConfigValue table = parse_config("samples = 4\n\nsampels = 8\n", "file.toml");
    ConfigReader reader(table, "file.toml");
    reader.integer("samples", 1, 1, 10);
    reader.text("title", "");
    EXPECT_THAT(message_of<ConfigError>([&] { reader.finish(); }),
                AllOf(HasSubstr("file.toml:3: sampels"), HasSubstr("did you mean 'samples'?")));
}

TEST(Config, AValueOfTheWrongTypeIsReportedWithBothTypes) {
    const ConfigValue table = parse_config("\nsamples = \"many\"", "file.toml");
    ConfigReader reader(table, "file.toml");
    EXPECT_THAT(message_of<ConfigError>([&] { reader.integer("samples", 1, 1, 10); }),
                AllOf(HasSubstr("file.toml:2: samples"), HasSubstr("whole number"), HasSubstr("a text")));
}

TEST(Config, AValueOutOfRangeIsReportedWithTheRange) {
    const ConfigValue table = parse_config("samples = 11\nradius = nan", "file.toml");
    ConfigReader reader(table, "file.toml");
    EXPECT_THAT(message_of<ConfigError>([&] { reader.integer("samples", 1, 1, 10); }),
                HasSubstr("is 11, but must be 1 to 10"));
    EXPECT_THAT(message_of<ConfigError>([&] { reader.number("radius", 1, 0, 10); }), HasSubstr("file.toml:2: radius"));
}

TEST(Config, AnInfiniteNumberIsANumber) {
    const ConfigValue table = parse_config("radius = inf", "file.toml");
    ConfigReader reader(table, "file.toml");
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(reader.number("radius", 1.0, 0.0, infinity), infinity);
}

TEST(Config, ErrorsInNestedTablesNameThePath) {
    const ConfigValue table = parse_config("[timing]\nrepetitons = 3\n[[scenes]]\nscene = 1", "file.toml");
    ConfigReader reader(table, "file.toml");
    ConfigReader timing = reader.table("timing");
    timing.integer("repetitions", 1, 1, 10);
    EXPECT_THAT(message_of<ConfigError>([&] { timing.finish(); }), HasSubstr("file.toml:2: timing.repetitons"));
    EXPECT_THAT(message_of<ConfigError>([&] { reader.tables("scenes")[0].required_text("scene"); }),
                HasSubstr("file.toml:4: scenes[1].scene"));
}

TEST(NearestName, IsTheOneWithTheFewestEditsAndNoneForAnotherWord) {
    const std::vector<std::string> names = {"radius", "samples", "layers"};
    EXPECT_EQ(nearest_name("sample", names), "samples");
    EXPECT_EQ(nearest_name("raduis", names), "radius");
    EXPECT_EQ(nearest_name("hysteresis", names), "");
}

}  // namespace
}  // namespace plumb
