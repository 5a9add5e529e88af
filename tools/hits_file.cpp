#include "hits_file.hpp"

#include <iterator>

#include <fmt/compile.h>

namespace fastccd::tools {
namespace {

constexpr std::size_t flush_size = std::size_t{1} << 20;

}  // namespace

HitsFile::HitsFile(const std::filesystem::path& path, bool proof) : file_{path}, proof_{proof}
{
    fmt::format_to(std::back_inserter(text_), "pair,toi{}\n", proof ? ",proven" : "");
}

void HitsFile::append(std::span<const Contact> contacts, std::span<const std::size_t> invalid, std::size_t first_pair)
{
    auto contact = contacts.begin();
    auto bad = invalid.begin();
    while (contact != contacts.end() || bad != invalid.end()) {
        if (bad == invalid.end() || (contact != contacts.end() && contact->pair < *bad)) {
            fmt::format_to(std::back_inserter(text_), FMT_COMPILE("{},{:.17g}{}\n"), first_pair + contact->pair,
                           contact->toi, !proof_ ? "" : contact->proven ? ",1" : ",0");
            ++contact;
        } else {
            fmt::format_to(std::back_inserter(text_), FMT_COMPILE("{},nan{}\n"), first_pair + *bad, proof_ ? "," : "");
            ++bad;
        }
        if (text_.size() >= flush_size) flush();
    }
}

void HitsFile::commit()
{
    flush();
    file_.commit();
}

void HitsFile::flush()
{
    file_.write({text_.data(), text_.size()});
    text_.clear();
}

}  // namespace fastccd::tools
