#include "instruction_sets.hpp"

namespace fastccd::tools {

std::string available_isas()
{
    std::string names;
    for (const Isa isa : all_isas) {
        if (!isa_available(isa)) continue;
        if (!names.empty()) names += ", ";
        names += name(isa);
    }
    return names;
}

}  // namespace fastccd::tools
