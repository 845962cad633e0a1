// JUnit XML, as CI services read it (the common subset: testsuites, testsuite, testcase, failure, error, properties).
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace plumb {

struct JunitCase {
    enum class Outcome { passed, failed, error };  // error: could not be decided

    std::string name, class_name;
    Outcome outcome = Outcome::passed;
    std::string message;  // one line
    std::string text;     // more of it; of a passed case: what it says to its standard output
    std::vector<std::pair<std::string, std::string>> properties;
};

struct JunitSuite {
    std::string name, timestamp;  // ISO 8601
    double seconds = 0.0;
    std::vector<std::pair<std::string, std::string>> properties;
    std::vector<JunitCase> cases;
};

// A whole document with one suite, in UTF-8.
std::string print_junit(const JunitSuite& suite);

// Text that may stand in an attribute or an element: markup is escaped; line ends and tabs keep their meaning in
// attributes; what XML 1.0 cannot hold (other control characters, bytes that are no UTF-8) becomes U+FFFD.
std::string escape_xml(std::string_view text);

}  // namespace plumb
