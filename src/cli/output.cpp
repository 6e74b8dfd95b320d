#include "output.hpp"

#include "../scene/reader.hpp"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

namespace qray::cli {

namespace {

char target[PATH_MAX];
char temporary[PATH_MAX]; // empty while there is none

void interrupted(int which, siginfo_t* info, void*)
{
    if ((which == SIGPIPE || which == SIGXFSZ) && info->si_pid == getpid())
        return; // sent by a write that fails, and tells so itself
    if (temporary[0] != 0)
        unlink(temporary);
    signal(which, SIG_DFL);
    raise(which);
}

// Where the links from `target` lead, which may not exist. False, and errno, where that is too long or endless.
bool follow_links()
{
    char next[PATH_MAX];
    for (int links = 0; links < 40; links++) {
        const ssize_t length = readlink(target, next, sizeof next);
        if (length < 0)
            return true;
        const char* slash = strrchr(target, '/');
        const size_t folder = next[0] == '/' || slash == nullptr ? 0 : static_cast<size_t>(slash + 1 - target);
        if (folder + static_cast<size_t>(length) >= sizeof target) {
            errno = ENAMETOOLONG;
            return false;
        }
        memcpy(target + folder, next, static_cast<size_t>(length));
        target[folder + static_cast<size_t>(length)] = 0;
    }
    errno = ELOOP;
    return false;
}

// A name of this process in the target's folder. False where it does not fit.
bool name_temporary()
{
    const char* slash = strrchr(target, '/');
    const int folder = slash != nullptr ? static_cast<int>(slash + 1 - target) : 0;
    const int length = snprintf(temporary, sizeof temporary, "%.*s.qray-%ld.part", folder, target,
                                static_cast<long>(getpid()));
    return length < static_cast<int>(sizeof temporary);
}

} // namespace

void catch_signals()
{
    struct sigaction ours = {}, old;
    ours.sa_sigaction = interrupted;
    ours.sa_flags = SA_SIGINFO | SA_RESTART;
    for (int which = 1; which <= SIGRTMAX; which++)
        switch (which) {
        case SIGKILL: // nobody catches this,
        case SIGCHLD: // and these end nothing
        case SIGCONT:
        case SIGSTOP:
        case SIGTSTP:
        case SIGTTIN:
        case SIGTTOU:
        case SIGURG:
        case SIGWINCH:
            break;
        default:
            if (sigaction(which, nullptr, &old) == 0 && old.sa_handler == SIG_DFL)
                sigaction(which, &ours, nullptr);
        }
}

bool Output::fail(const char* what, int error)
{
    action = what;
    reason = error;
    return false;
}

int Output::report() const
{
    fprintf(stderr, "%s: cannot %s: %s\n", scene::ShownName(shown).text, action, strerror(reason));
    return 1;
}

Output::~Output()
{
    if (temporary[0] != 0)
        unlink(temporary);
    temporary[0] = 0;
}

bool Output::open(const char* name)
{
    shown = name;
    if (strcmp(name, "-") == 0) {
        file = STDOUT_FILENO;
        return true;
    }
    struct stat old;
    const bool exists = stat(name, &old) == 0;
    if (exists && !S_ISREG(old.st_mode)) {
        file = ::open(name, O_WRONLY | O_CLOEXEC);
        return file >= 0 || fail("open", errno);
    }
    // Behind a link, the file itself is replaced; and one that must not be written to is not.
    if (snprintf(target, sizeof target, "%s", name) >= static_cast<int>(sizeof target))
        return fail("open", ENAMETOOLONG);
    if (!follow_links() || (exists && access(target, W_OK) != 0))
        return fail("open", errno);
    if (!name_temporary()) {
        temporary[0] = 0;
        return fail("open", ENAMETOOLONG);
    }
    unlink(temporary); // left by an earlier process of that number
    file = ::open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0) {
        const int error = errno;
        temporary[0] = 0;
        return fail("open", error);
    }
    return !exists || fchmod(file, old.st_mode & 07777) == 0 || fail("open", errno);
}

bool Output::write(const void* bytes, size_t size)
{
    const char* from = static_cast<const char*>(bytes);
    while (size != 0) {
        const ssize_t put = ::write(file, from, size);
        if (put < 0 && errno != EINTR)
            return fail("write", errno);
        from += put > 0 ? put : 0;
        size -= put > 0 ? static_cast<size_t>(put) : 0;
    }
    return true;
}

bool Output::commit()
{
    if (close(file) != 0)
        return fail("write", errno);
    if (temporary[0] == 0)
        return true;
    if (rename(temporary, target) != 0)
        return fail("write", errno);
    temporary[0] = 0;
    return true;
}

} // namespace qray::cli
