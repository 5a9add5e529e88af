#include "interrupt.hpp"

#include <atomic>
#include <csignal>
#include <initializer_list>

#include <signal.h>
#include <time.h>

namespace fastccd::tools {
namespace {

std::atomic<int> pending_signal = 0;  // any thread may ask for it
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler must not wait");
timespec first_signal{};
bool broken_pipes_ignored = false;  // by who started the process

/// A second Ctrl-C ends a process that cannot get to check_interrupt. `timeout` sends a signal to its child and then to the
/// group, so that the same one comes twice at once: only one that comes later than a finger is meant like that.
constexpr double seconds_until_second = 0.3;

extern "C" void note_signal(int signal)
{
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    if (pending_signal == 0) {
        first_signal = now;
        pending_signal = signal;
        return;
    }
    const double seconds =
        static_cast<double>(now.tv_sec - first_signal.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec - first_signal.tv_nsec);
    if (seconds < seconds_until_second) return;
    fastccd::tools::end_by(signal);  // delivered on return from here
}

}  // namespace

void end_by(int signal)
{
    if (signal == SIGPIPE && broken_pipes_ignored) return;
    struct sigaction action {};
    action.sa_handler = SIG_DFL;
    sigaction(signal, &action, nullptr);
    raise(signal);
}

void install_signal_handlers()
{
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction previous {};
        // A job started with `nohup` or in the background of a script ignores these on purpose.
        if (sigaction(signal, nullptr, &previous) == 0 && previous.sa_handler == SIG_IGN) continue;
        struct sigaction action {};
        action.sa_handler = note_signal;
        // No SA_RESTART: a write blocked on a full pipe has to wake up. One handler at a time, whatever comes in.
        for (const int other : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&action.sa_mask, other);
        sigaction(signal, &action, nullptr);
    }
    broken_pipes_ignored = std::signal(SIGPIPE, SIG_IGN) == SIG_IGN;
    std::signal(SIGXFSZ, SIG_IGN);
}

void check_interrupt()
{
    if (const int signal = pending_signal; signal != 0) throw Interrupted{signal};
}

}  // namespace fastccd::tools
