// Methods that an experiment takes from files of their own, such as 'plumbline tune' writes, named relative to the
// experiment's file: methods = ["tuned/mine.toml"], or base = "tuned/mine.toml" in a method's table.
#pragma once

#include <map>
#include <string>

#include "experiments/method_file.h"

namespace plumb {

// Their texts by the names that the experiment uses. A record of a run keeps them, so that it can be repeated where the
// files are not.
using MethodFiles = std::map<std::string, std::string>;

class MethodFileReader {
public:
    // Of the experiment that `reader` reads, which asks for `planes`; a text that `kept` has is not looked for on the
    // disk. Keeps references.
    MethodFileReader(const ConfigReader& reader, const std::vector<std::string>& planes, const MethodFiles& kept)
        : reader_(reader), planes_(planes), kept_(kept) {}

    // Whether a method's name means a file.
    static bool is_file(const std::string& name);
    // Throws ConfigError for a file that is not there, with where it was looked for, and for what is wrong in it.
    Method load(const std::string& name);
    // Makes the file that the table has as its base, if it has one, known under the name that the table uses.
    void add_base(const ConfigValue& table, MethodList& known);

    const MethodFiles& files() const { return files_; }

private:
    const ConfigReader& reader_;
    const std::vector<std::string>& planes_;
    const MethodFiles& kept_;
    MethodFiles files_;
};

}  // namespace plumb
