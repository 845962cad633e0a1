// JUnit and JSON of a check, read back by Python's own parsers.
#include "experiments/check_report.h"

#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/experiments/program.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// What Python makes of a JUnit file: counts, then one line per case with its outcome, name, message and text.
constexpr const char* report_reader = R"(import json, sys, xml.etree.ElementTree as tree
suite = tree.parse(sys.argv[1]).getroot().find('testsuite')
cases = []
for case in suite.findall('testcase'):
    bad = [element for element in case if element.tag in ('failure', 'error')]
    cases.append({'name': case.get('name'), 'class': case.get('classname'), 'outcome': bad[0].tag if bad else 'passed',
                  'message': bad[0].get('message') if bad else '', 'text': bad[0].text if bad else case.findtext('system-out'),
                  'properties': {p.get('name'): p.get('value') for p in case.iter('property')}})
print(json.dumps({'attributes': suite.attrib, 'cases': cases}))
)";

nlohmann::json read_junit(const std::string& text) {
    const TemporaryFolder folder;
    std::ofstream(folder.path / "reader.py") << report_reader;
    std::ofstream(folder.path / "junit.xml") << text;
    const ProgramRun run =
        run_shell("python3 " + (folder.path / "reader.py").string() + " " + (folder.path / "junit.xml").string());
    EXPECT_EQ(run.exit_code, 0) << run.output << text;
    return nlohmann::json::parse(run.output);
}

Verdict verdict(const std::string& name, VerdictStatus status, double value) {
    Verdict result;
    result.threshold.name = name;
    result.threshold.limit = 0.25;
    result.threshold.reason = "a < b & \"c\"";
    result.threshold.calibrated = CalibratedValue{10, 0.2, 0.01, 0.18, 0.22};
    result.value.value = value, result.value.place = "cornell / front", result.value.rows = 1;
    result.status = status;
    result.message = "rmse = " + std::to_string(value);
    return result;
}

class CheckReport : public testing::Test {
protected:
    CheckReport() {
        check_.experiment.name = "ci <&>";
        check_.experiment.file = "somewhere/ci.toml";
        results_.run.started = "2026-01-31T23:59:59Z";
        results_.run.system.cpu = "a \"fast\" one";
        results_.seconds = 12.3456;
        results_.verdicts = {verdict("kept", VerdictStatus::kept, 0.2),
                             verdict("broken <limit>", VerdictStatus::breached, 0.5),
                             verdict("lost", VerdictStatus::unmatched, 0.1)};
        results_.verdicts[2].value.value.reset();
        results_.must_fail = {{"proof", verdict("x", VerdictStatus::breached, 0.9), true, "breaks"},
                              {"no proof", verdict("x", VerdictStatus::kept, 0.1), false, "the gate cannot fail"}};
    }
    CheckFile check_;
    CheckResults results_;
};

TEST_F(CheckReport, JunitHasACaseForEachThresholdEachProofAndTheCells) {
    const nlohmann::json suite = read_junit(print_junit(junit_of(check_, results_)));
    EXPECT_EQ(suite["attributes"]["name"], "plumbline check ci <&>");
    EXPECT_EQ(suite["attributes"]["tests"], "6");
    EXPECT_EQ(suite["attributes"]["failures"], "2");
    EXPECT_EQ(suite["attributes"]["errors"], "1");
    EXPECT_EQ(suite["attributes"]["time"], "12.346");
    EXPECT_EQ(suite["attributes"]["timestamp"], "2026-01-31T23:59:59");
    ASSERT_EQ(suite["cases"].size(), 6u);
    const auto outcomes = [&](std::size_t i) { return suite["cases"][i]["outcome"].get<std::string>(); };
    EXPECT_EQ(outcomes(0), "passed") << "cells";
    EXPECT_EQ(outcomes(1), "passed");
    EXPECT_EQ(outcomes(2), "failure");
    EXPECT_EQ(outcomes(3), "error");
    EXPECT_EQ(outcomes(4), "passed");
    EXPECT_EQ(outcomes(5), "failure");
    const nlohmann::json& broken = suite["cases"][2];
    EXPECT_EQ(broken["name"], "broken <limit>");
    EXPECT_EQ(broken["class"], "plumbline.error");
    EXPECT_EQ(broken["message"], "rmse = 0.500000");
    EXPECT_THAT(broken["text"].get<std::string>(),
                AllOf(HasSubstr("limit <= 0.25"), HasSubstr("margin -100.0 %"), HasSubstr("change +150.0 %"),
                      HasSubstr("reason of the limit: a < b & \"c\"")));
    EXPECT_EQ(broken["properties"]["value"], "0.5");
    EXPECT_EQ(broken["properties"]["calibrated"], "0.2");
}

TEST_F(CheckReport, JunitTellsOfCellsThatFailed) {
    results_.failed_cells = {"cornell / front: one", "cornell / gap: two"};
    const nlohmann::json cells = read_junit(print_junit(junit_of(check_, results_)))["cases"][0];
    EXPECT_EQ(cells["outcome"], "failure");
    EXPECT_EQ(cells["message"], "2 failed, the first: cornell / front: one");
    EXPECT_EQ(cells["text"], "cornell / front: one\ncornell / gap: two");
}

TEST(Junit, EveryByteMakesWellFormedXmlAndAllowedTextSurvives) {
    JunitSuite suite;
    JunitCase all;
    for (int byte = 0; byte < 256; ++byte) all.name.push_back(static_cast<char>(byte));
    JunitCase allowed;
    allowed.outcome = JunitCase::Outcome::failed;
    allowed.name = allowed.message = "tab\tline\nreturn\r<>&\"' ü € 😀";
    allowed.text = "]]> <![CDATA[";
    JunitCase forbidden;  // overlong, a surrogate, beyond Unicode, not a character, cut off
    forbidden.name = "\xC0\x80|\xED\xA0\x80|\xF4\x90\x80\x80|\xEF\xBF\xBE|\xE2\x82";
    suite.cases = {all, allowed, forbidden};
    const nlohmann::json cases = read_junit(print_junit(suite))["cases"];
    EXPECT_THAT(cases[0]["name"].get<std::string>(), AllOf(HasSubstr(" !\"#$%&'("), HasSubstr("\xEF\xBF\xBD")));
    EXPECT_EQ(cases[1]["name"], allowed.name);
    EXPECT_EQ(cases[1]["message"], allowed.message);
    EXPECT_EQ(cases[1]["text"], allowed.text);
    const std::string r = "\xEF\xBF\xBD";
    EXPECT_EQ(cases[2]["name"], r + r + "|" + r + r + r + "|" + r + r + r + r + "|" + r + r + r + "|" + r + r);
}

TEST_F(CheckReport, JsonTellsValuesLimitsAndVerdicts) {
    const nlohmann::json json = nlohmann::json::parse(print_check_json(check_, results_));
    EXPECT_EQ(json["exit_code"], 1);
    EXPECT_EQ(json["file"], "ci.toml") << "without the folder of this machine";
    ASSERT_EQ(json["thresholds"].size(), 3u);
    EXPECT_EQ(json["thresholds"][1]["verdict"], "breached");
    EXPECT_EQ(json["thresholds"][1]["fail_above"], 0.25);
    EXPECT_DOUBLE_EQ(json["thresholds"][1]["margin"].get<double>(), -1.0);
    EXPECT_DOUBLE_EQ(json["thresholds"][1]["change"].get<double>(), 1.5);
    EXPECT_EQ(json["thresholds"][1]["moved"], true);
    EXPECT_TRUE(json["thresholds"][2]["value"].is_null());
    EXPECT_EQ(json["must_fail"][1]["proven"], false);
}

TEST_F(CheckReport, TheTableSaysWhyALimitIsThere) {
    const std::string table = print_check_table(results_);
    EXPECT_THAT(table,
                AllOf(HasSubstr("BREACHED"), HasSubstr("+150.0 %"), HasSubstr("reason of the limit: a < b & \"c\""),
                      HasSubstr("NO PROOF: 'no proof' the gate cannot fail")));
}

TEST_F(CheckReport, FilesAppearWholeAndTogether) {
    const TemporaryFolder folder;
    write_check_files(check_, results_, folder.path / "new");
    EXPECT_TRUE(std::filesystem::exists(folder.path / "new/junit.xml"));
    EXPECT_TRUE(std::filesystem::exists(folder.path / "new/check.json"));
}

}  // namespace
}  // namespace plumb
