#include "hits_file.hpp"

namespace fastccd::tools {

HitsFile::HitsFile(const std::filesystem::path& path, bool proof) : rows_{path}, proof_{proof}
{
    rows_.append(FMT_COMPILE("pair,toi{}\n"), proof ? ",proven" : "");
}

void HitsFile::append(std::span<const Contact> contacts, std::span<const std::size_t> invalid, std::size_t first_pair)
{
    auto contact = contacts.begin();
    auto bad = invalid.begin();
    while (contact != contacts.end() || bad != invalid.end()) {
        if (bad == invalid.end() || (contact != contacts.end() && contact->pair < *bad)) {
            rows_.append(FMT_COMPILE("{},{:.17g}{}\n"), first_pair + contact->pair, contact->toi,
                         !proof_ ? "" : contact->proven ? ",1" : ",0");
            ++contact;
        } else {
            rows_.append(FMT_COMPILE("{},nan{}\n"), first_pair + *bad, proof_ ? "," : "");
            ++bad;
        }
    }
}

}  // namespace fastccd::tools
