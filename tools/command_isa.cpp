#include <memory>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <fastccd/isa.hpp>

#include "commands.hpp"
#include "common_options.hpp"
#include "instruction_sets.hpp"
#include "narrow_phase_run.hpp"
#include "output_file.hpp"

namespace fastccd::tools {
namespace {

const char* availability(Isa isa)
{
    if (!isa_built(isa)) return "not in this build";
    return isa_available(isa) ? "available" : "not on this machine";
}

std::string text(Isa chosen)
{
    std::string out;
    for (const Isa isa : all_isas) {
        const std::string width = fmt::format("{} pair{} at a time", lanes(isa), lanes(isa) == 1 ? "" : "s");
        out += fmt::format("{:<8}{:<20}{}{}\n", name(isa), width, availability(isa), isa == chosen ? ", used" : "");
    }
    return out;
}

std::string json(Isa chosen)
{
    nlohmann::ordered_json sets = nlohmann::ordered_json::array();
    for (const Isa isa : all_isas) {
        sets.push_back({{"name", name(isa)},
                        {"lanes", lanes(isa)},
                        {"built", isa_built(isa)},
                        {"available", isa_available(isa)}});
    }
    return nlohmann::ordered_json{{"used", name(chosen)}, {"isas", std::move(sets)}}.dump() + "\n";
}

}  // namespace

void add_isa_command(CLI::App& app)
{
    CLI::App* const command = app.add_subcommand(
        "isa", "List instruction sets, and which is used unless --isa says\notherwise");
    const auto as_json = std::make_shared<bool>(false);
    command->add_flag("--json", *as_json, "As one JSON object");
    command->callback([as_json] {
        const Isa chosen = resolve_isa({});
        write_all(STDOUT_FILENO, *as_json ? json(chosen) : text(chosen), "standard output");
    });
}

}  // namespace fastccd::tools
