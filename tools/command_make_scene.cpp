#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "commands.hpp"
#include "common_options.hpp"
#include "input_error.hpp"
#include "interrupt.hpp"
#include "output_file.hpp"
#include "progress.hpp"
#include "report_totals.hpp"
#include "scene/make_scene.hpp"
#include "shown_text.hpp"

namespace fastccd::tools {
namespace {

struct MakeSceneOptions {
    std::string scene;
    std::uint64_t size = 100;
    std::uint64_t frames = 10;
    std::string out_dir;
    bool quiet = false;
};

/// Overwriting is fine where it changes nothing: the same command may be given twice. Any other mesh under a
/// name of ours may be somebody's work.
void refuse_other_frames(const ClothBall& scene, const std::filesystem::path& out_dir)
{
    for (int frame = 0; frame < scene.frames(); ++frame) {
        const std::filesystem::path path = out_dir / frame_name(frame, scene.frames());
        std::error_code error;
        if (!std::filesystem::exists(path, error)) continue;
        bool same = false;
        try {
            const Mesh mesh = read_mesh(path);
            same = mesh.faces == scene.faces() && mesh.lines.empty() && mesh.positions == scene.positions(frame);
        } catch (const InputError&) {
            // No mesh that can be read: not ours.
        }
        if (!same) throw InputError(path, "is there already, and is not this frame of a scene of this size and number of frames; name an empty folder");
        check_interrupt();
    }
}

/// A path as a shell takes it.
std::string quoted(const std::string& path)
{
    constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
    if (path.find_first_not_of(plain) == std::string::npos) return path;
    if (on_one_line(path) != path) {  // bytes as escapes, which drive no terminal
        std::string text = "$'";
        for (const char c : path) text += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
        return text + "'";
    }
    std::string text = "'";
    for (const char c : path) text += c == '\'' ? std::string{"'\\''"} : std::string(1, c);
    return text + "'";
}

void make_scene_command(const MakeSceneOptions& options)
{
    const auto size = static_cast<int>(options.size);
    const auto frames = static_cast<int>(options.frames);
    const std::filesystem::path out_dir{options.out_dir};
    const ClothBall scene{size, frames};
    refuse_other_frames(scene, out_dir);
    {
        Progress progress{options.frames, !options.quiet};
        int written = 0;
        progress.set_place(fmt::format("frame 1 of {}", frames));
        make_cloth_ball(size, frames, out_dir, [&] {
            check_interrupt();
            ++written;
            progress.set_place(fmt::format("frame {} of {}", std::min(written + 1, frames), frames));
            progress.advance(1);
        });
    }
    if (options.quiet) return;
    const auto path = [&](const std::string& name) { return (out_dir / name).string(); };
    const std::string folder = (out_dir / "").parent_path().string();
    const std::string text =
        fmt::format("wrote {} frames, {} to {}: {}, {} each\nnow:  fastccd scene {}/frame_*.ply\n", frames,
                    on_one_line(path(frame_name(0, frames))), on_one_line(path(frame_name(frames - 1, frames))),
                    counted(scene.positions(0).size() / 3, "vertex", "vertices"), counted(scene.faces().size() / 3, "face"),
                    quoted(folder.starts_with('-') ? "./" + folder : folder));
    write_all(STDOUT_FILENO, text, "standard output");
}

}  // namespace

void add_make_scene_command(CLI::App& app)
{
    CLI::App* const command = app.add_subcommand("make-scene", "Write the frames of a scene to try `fastccd scene` on");
    const auto options = std::make_shared<MakeSceneOptions>();
    command
        ->add_option("SCENE", options->scene, "cloth-ball: a cloth falls on a spinning ball and folds")
        ->required()
        ->check([](const std::string& scene) {
            return scene == "cloth-ball" ? std::string{} : fmt::format("there is no scene '{}'; cloth-ball is one", scene);
        })
        ->type_name("");
    command
        ->add_option("OUT", options->out_dir,
                     "Folder for frame_000.ply and so on, created if need be; may\n"
                     "not hold other meshes")
        ->required()
        ->check(not_empty())
        ->type_name("");
    // The generator's own limits; a single frame would be no step.
    add_whole_number(*command, "--size", options->size, 2, 4096, "The cloth has N x N vertices")
        ->default_str(std::to_string(options->size));
    add_whole_number(*command, "--frames", options->frames, 2, 100'000, "Number of frames")
        ->default_str(std::to_string(options->frames));
    command->add_flag("--quiet", options->quiet, "No progress bar, and no word on what was written");
    command->callback([options] { make_scene_command(*options); });
}

}  // namespace fastccd::tools
