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
    return error.say("%s: cannot %s: %s", scene::ShownName(path).text, what, strerror(errno));
}

// Appends a file to `to`, or its first `most` + 1 bytes. Closes it; 0, or what errno would be.
int read_all(int file, size_t most, scene::Bytes& to, struct stat& found)
{
    if (file < 0)
        return errno;
    int wrong = fstat(file, &found) == 0 && S_ISDIR(found.st_mode) ? EISDIR : 0;
    size_t expected = S_ISREG(found.st_mode) ? static_cast<size_t>(found.st_size) + 1 : 65536; // may be wrong
    for (const size_t end = to.size + most + 1; wrong == 0 && to.size < end; expected = to.size) {
        if (to.size == to.room.size && !grow_room(to.room, std::min(to.size + expected, end)))
            wrong = ENOMEM;
        const ssize_t got = wrong == 0 ? read(file, to.room.at + to.size, std::min(to.room.size, end) - to.size) : 0;
        if (got == 0)
            break;
        if (got < 0 && errno != EINTR)
            wrong = errno;
        to.size += got > 0 ? static_cast<size_t>(got) : 0;
    }
    if (file != STDIN_FILENO)
        close(file);
    return wrong;
}

const char* append_file(const char* path, size_t most, scene::Bytes& to)
{
    struct stat found;
    const int wrong = read_all(open(path, O_RDONLY | O_CLOEXEC), most, to, found);
    return wrong == 0 ? nullptr : strerror(wrong);
}

} // namespace

bool read_scene(const char* path, scene::Description& description, scene::Error& error)
{
    const bool standard = strcmp(path, "-") == 0;
    const int file = standard ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC);
    scene::Bytes text;
    errno = read_all(file, scene::Limits::text, text, scene_file);
    if (errno != 0)
        return failed(error, path, file < 0 || errno == EISDIR ? "open" : "read");
    if (text.size > scene::Limits::text)
        return error.say("%s:1:1: a text of more than %u bytes (limit 'text')", scene::ShownName(path).text,
                         scene::Limits::text);
    if (!make_room(description.room, description.lay_out(text.size))) {
        errno = ENOMEM;
        return failed(error, path, "read");
    }
    constexpr scene::Files files{append_file, grow_room};
    const bool good =
        scene::parse(path, reinterpret_cast<const char*>(text.room.at), text.size, description, error, &files);
    give_back(text.room);
    give_back(description.files.room);
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
