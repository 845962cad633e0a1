// Judged claims as files: claims.json beside each experiment's results, and CLAIMS.md, the table of all of them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/claims.h"

namespace plumb {

// What a table needs to know of a judged claim; read back from claims.json.
struct ClaimRecord {
    std::string experiment, claim, source, test;
    std::string measured;  // "1.87 times [1.6, 2.1]"
    std::string range;     // "above 1.6 and below 2.2"
    std::string verdict, reason;
    std::vector<std::pair<std::string, std::string>> scenes;  // each scene's own figure
    int cases = 0, missing = 0;
    bool quick = false;  // of a trial run, which proves nothing
    std::string key;     // of what was measured with what (reproduction_key.h); empty where that is not known
};

ClaimRecord record_of(const ClaimResult& result, bool quick, const std::string& key = "");

// Records and, of each, the mean and interval as numbers.
std::string print_claims_json(const std::vector<ClaimResult>& results, bool quick, const std::string& key = "");
// Throws ConfigError for a file that is not one.
std::vector<ClaimRecord> read_claims_json(const std::filesystem::path& file);

// For a terminal, one block per claim.
std::string print_claims_text(const std::vector<ClaimRecord>& records);
// The table of all claims with a tally; `command` is what makes it again.
std::string print_claims_markdown(const std::vector<ClaimRecord>& records, const std::string& command);

}  // namespace plumb
