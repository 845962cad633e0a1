// Which program this is, to the last bit: what was measured by another one may not hold for it.
#pragma once

#include <string>

namespace plumb {

// Of the file of the program that runs; where the system does not tell it, of nothing.
std::string program_checksum();

// Of a text, as 32 hexadecimal digits.
std::string text_checksum(const std::string& text);

}  // namespace plumb
