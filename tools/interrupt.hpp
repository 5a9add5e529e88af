// Ctrl-C and termination, met between chunks of work so that files and the terminal are left clean.
#pragma once

namespace fastccd::tools {

/// Thrown by check_interrupt. Not a std::exception: only main may swallow it.
struct Interrupted {
    int signal;
};

/// The reader of our output went away (`| head`). Nothing more to say, and nobody to say it to.
struct BrokenPipe {};

/// Notes SIGINT, SIGTERM and SIGHUP for check_interrupt; one more, a third of a second or more after the
/// first, ends the process at once. Writing to a closed pipe becomes an error (BrokenPipe) instead of a
/// signal, and so does writing beyond the largest file allowed.
void install_signal_handlers();

/// Throws Interrupted if a signal has come in. Call it at least every tenth of a second of work; from any thread.
void check_interrupt();

/// Ends the process by the signal, as if it had never been handled: a shell that runs a loop or a script goes on after a command
/// that exits upon Ctrl-C, and stops after one that the signal has ended. Returns if the signal is blocked, or was ignored when the process began.
void end_by(int signal);

}  // namespace fastccd::tools
