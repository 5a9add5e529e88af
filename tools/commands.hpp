// The subcommands. Each function adds one to the command line, which runs it when it is given.
#pragma once

namespace CLI {
class App;
}

namespace fastccd::tools {

/// `fastccd random`: the paper's random test.
void add_random_command(CLI::App& app);

/// `fastccd run`: the pairs in files.
void add_run_command(CLI::App& app);

/// `fastccd scene`: all candidate pairs of the steps between mesh frames.
void add_scene_command(CLI::App& app);

/// `fastccd make-scene`: frames for those who have none.
void add_make_scene_command(CLI::App& app);

/// `fastccd report`: speed against error on this machine.
void add_report_command(CLI::App& app);

/// `fastccd isa`: instruction sets of this build and machine.
void add_isa_command(CLI::App& app);

}  // namespace fastccd::tools
