#include "interrupt.hpp"

#include <csignal>
#include <initializer_list>

#include <signal.h>

namespace fastccd::tools {
namespace {

volatile std::sig_atomic_t pending_signal = 0;

extern "C" void note_signal(int signal)
{
    pending_signal = signal;
}

}  // namespace

void install_signal_handlers()
{
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction previous {};
        // A job started with `nohup` or in the background of a script ignores these on purpose.
        if (sigaction(signal, nullptr, &previous) == 0 && previous.sa_handler == SIG_IGN) continue;
        struct sigaction action {};
        action.sa_handler = note_signal;
        // No SA_RESTART: a write blocked on a full pipe has to wake up. Reset after the first: a
        // second Ctrl-C ends a process that cannot get to check_interrupt.
        action.sa_flags = static_cast<int>(SA_RESETHAND);
        sigemptyset(&action.sa_mask);
        sigaction(signal, &action, nullptr);
    }
    std::signal(SIGPIPE, SIG_IGN);
}

void check_interrupt()
{
    if (pending_signal != 0) throw Interrupted{pending_signal};
}

}  // namespace fastccd::tools
