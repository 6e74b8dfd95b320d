#include "input.hpp"

#include "../scene/reader.hpp"
#include "memory.hpp"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

namespace qray::cli {

namespace {

struct stat scene_file;

bool failed(scene::Error& error, const char* path, const char* what)
{
    snprintf(error.text, sizeof error.text, "%s: cannot %s: %s", scene::ShownName(path).text, what, strerror(errno));
    return false;
}

// Bytes read, or -1 and errno. `expected` is how many there should be, and may be wrong.
ptrdiff_t read_all(int file, size_t expected, scene::Room& text)
{
    constexpr size_t most = scene::Limits::text + 1; // one more, to see that a file is too long
    size_t size = 0;
    while (size < most) {
        if (size == text.size && !grow_room(text, std::min(size == 0 ? expected + 1 : 2 * size, most))) {
            errno = ENOMEM;
            return -1;
        }
        const ssize_t got = read(file, text.at + size, text.size - size);
        if (got == 0)
            break;
        if (got < 0 && errno != EINTR)
            return -1;
        size += got > 0 ? static_cast<size_t>(got) : 0;
    }
    return static_cast<ptrdiff_t>(size);
}

} // namespace

bool read_scene(const char* path, scene::Description& description, scene::Error& error)
{
    const bool standard = strcmp(path, "-") == 0;
    const int file = standard ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0)
        return failed(error, path, "open");
    if (fstat(file, &scene_file) == 0 && S_ISDIR(scene_file.st_mode)) {
        errno = EISDIR;
        return failed(error, path, "open");
    }
    const size_t expected = S_ISREG(scene_file.st_mode) ? static_cast<size_t>(scene_file.st_size) : 65535;
    scene::Room text;
    const ptrdiff_t size = read_all(file, expected, text);
    if (size < 0)
        return failed(error, path, "read");
    if (!standard)
        close(file);
    if (size > ptrdiff_t{scene::Limits::text}) {
        snprintf(error.text, sizeof error.text, "%s:1:1: a text of more than %u bytes (limit 'text')",
                 scene::ShownName(path).text, scene::Limits::text);
        return false;
    }
    const size_t bytes = static_cast<size_t>(size);
    if (!make_room(description.room, description.lay_out(bytes))) {
        errno = ENOMEM;
        return failed(error, path, "read");
    }
    const bool good = scene::parse(path, reinterpret_cast<const char*>(text.at), bytes, description, error);
    give_back(text);
    return good;
}

bool is_scene_file(const char* path)
{
    struct stat other;
    const bool found = strcmp(path, "-") == 0 ? fstat(STDOUT_FILENO, &other) == 0 : stat(path, &other) == 0;
    return found && S_ISREG(other.st_mode) && other.st_dev == scene_file.st_dev
        && other.st_ino == scene_file.st_ino;
}

} // namespace qray::cli
