#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace fastccd::tools {

/// A file the user named cannot be used: missing, unreadable, unwritable or malformed. `what()` is
/// one line, "PATH: MESSAGE", where the message gives the place in the file and what to do about
/// it.
class InputError : public std::runtime_error {
public:
    InputError(const std::filesystem::path& path, std::string_view message)
        : std::runtime_error(path.string() + ": " + std::string(message))
    {
    }
};

}  // namespace fastccd::tools
