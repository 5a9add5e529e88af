#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "commands.hpp"
#include "common_options.hpp"
#include "output_file.hpp"
#include "scene/saved_pairs.hpp"
#include "scene/scene_report.hpp"
#include "scene/scene_run.hpp"

namespace fastccd::tools {

namespace {

void refuse_overwriting_by_pairs(const SceneOptions& options)
{
    std::set<std::filesystem::path> frames;  // of their places, as there may be thousands of both
    for (const std::string& frame : options.frames) frames.insert(OutputFile::place(frame));
    const std::filesystem::path folder = options.save_pairs;
    for (const std::string& name : SavedPairs::file_names(options.frames.size() - 1)) {
        const std::filesystem::path file = folder / name;
        if (frames.contains(OutputFile::place(file)))
            throw CLI::ValidationError("--save-pairs", fmt::format("{} is an input", file.string()));
        refuse_overwriting_output(options.common, file);
    }
    const std::string hits = std::filesystem::path{options.common.hits}.filename();
    if (SavedPairs::is_name_of_pairs(hits)) refuse_overwriting_output(options.common, folder / hits);  // of steps that this scene has not
}

}  // namespace

void add_scene_command(CLI::App& app)
{
    CLI::App* const command = app.add_subcommand("scene", "Answer all that may touch in the frames of a moving mesh, but for pairs that share a vertex");
    const auto options = std::make_shared<SceneOptions>();
    command
        ->add_option("FRAME", options->frames,
                     "Two or more meshes with the same faces, in order of time; from\n"
                     "each to the next is a step. PLY (ascii or binary) or .obj,\n"
                     "triangles only; lines (OBJ: l, PLY: edge) are edges, too")
        ->required()
        ->check(not_empty())
        ->type_name("");
    command
        ->add_option("--save-pairs", options->save_pairs,
                     "Also write the candidates as .npy for `fastccd run`, 192 bytes\n"
                     "each, to DIR/step_000_vf.npy, step_000_ee.npy and so on")
        ->check(output_folder_name())
        ->type_name("DIR");
    add_search_options(*command, options->common);
    add_separation_options(*command, options->common);
    add_report_options(*command, options->common,
                       "step,kind,v0,v1,v2,v3,toi; vf: the vertex,\nthen the face's; ee: the first edge's, then the second's", "it names all invalid vertices");
    command->callback([options] {
        if (options->frames.size() < 2) {
            throw CLI::ValidationError("FRAME", "a step is from one frame to another; name two or more");
        }
        refuse_overwriting_input(options->common, options->frames);
        refuse_overwriting_report(options->common);
        if (!options->save_pairs.empty()) refuse_overwriting_by_pairs(*options);
        print_scene_report(*options, run_scene(*options));
    });
}

}  // namespace fastccd::tools
