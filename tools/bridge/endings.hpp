// Endings of picture files, and how a file of each begins by the specification of its format.
#ifndef RETEX_BRIDGE_ENDINGS_HPP
#define RETEX_BRIDGE_ENDINGS_HPP

#include <string>
#include <vector>

namespace bridge
{

std::string lower(std::string text);
bool has_known_ending(const std::string &ending);
// One of each format, but for those that libretex writes itself.
std::vector<std::string> known_endings();
// ending is in small letters; begin: the first 64 bytes of a file.
bool begins_as(const std::string &ending, const std::string &begin);

} // namespace bridge
#endif
