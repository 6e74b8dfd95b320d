#include "check.hpp"

#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

namespace qray::cli {

namespace {

// make hands names on to a shell.
bool plain(const char* name)
{
    constexpr const char* letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_+-./";
    return strspn(name, letters) == strlen(name);
}

void take(const char* line, Truth& truth)
{
    double value = 0;
    if (sscanf(line, "instructions: %lf", &value) == 1)
        truth.instructions = value;
    else if (sscanf(line, "flash: %lf", &value) == 1)
        truth.flash = value;
    else if (sscanf(line, "ram: %lf", &value) == 1 || sscanf(line, "stack: %lf", &value) == 1)
        truth.ram += value;
    else
        sscanf(line, "picture: %299[^\n]", truth.picture);
}

} // namespace

bool run_firmware(const char* scene, const char* const* variables, Truth& truth)
{
    if (!plain(scene)) {
        fputs("qray: '--check' needs a scene whose name make understands: letters, digits, _+-./\n", stderr);
        return false;
    }
    const char* words[16] = {"make", "--no-print-directory", "run", "RAYS=no", "NAME=plan"};
    int n = 5;
    for (; *variables != nullptr; variables++)
        words[n++] = *variables;
    int ends[2];
    if (pipe(ends) != 0) {
        perror("qray: pipe");
        return false;
    }
    const pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], STDOUT_FILENO);
        close(ends[0]);
        close(ends[1]);
        execvp("make", const_cast<char* const*>(words));
        perror("qray: make");
        _exit(127);
    }
    close(ends[1]);
    FILE* lines = fdopen(ends[0], "r");
    char line[400];
    while (lines != nullptr && fgets(line, sizeof line, lines) != nullptr)
        take(line, truth);
    if (lines != nullptr)
        fclose(lines);
    int status = -1;
    if (child > 0)
        waitpid(child, &status, 0);
    if (status == 0 && truth.instructions > 0 && truth.picture[0] != 0)
        return true;
    fprintf(stderr, "qray: make run failed; '--check' works in qray's own folder, where its Makefile is\n");
    return false;
}

bool compare_picture(const char* path, const Renderer& renderer, const Built& built, study::Errors& errors)
{
    static uint8_t drawn[3 * scene::Limits::resolution], exact[3 * scene::Limits::resolution];
    FILE* file = fopen(path, "rb");
    uint32_t width = 0, height = 0;
    bool good = file != nullptr && fscanf(file, "P6 %u %u 255", &width, &height) == 2 && fgetc(file) == '\n'
        && width == built.width && height == built.height;
    RayCounts counts;
    for (uint32_t j = 0; good && j < height; j++) {
        good = fread(drawn, 3, width, file) == width;
        renderer.rows(j, j + 1, exact, counts);
        errors.add(drawn, exact, width);
    }
    if (file != nullptr)
        fclose(file);
    if (!good)
        fprintf(stderr, "qray: %s is not the picture that was expected\n", path);
    return good;
}

} // namespace qray::cli
