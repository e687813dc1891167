#include <maximin/apps/common/graphviz_program.hpp>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include <maximin/theory/error.hpp>

extern char** environ;

namespace maximin::apps {

namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// A file without a name, gone when it is closed.
File nameless_file() {
  File file(std::tmpfile(), &std::fclose);
  if (!file) throw InputError(fmt::format("temporary file: {}, expected room for one", std::strerror(errno)));
  return file;
}

std::string content_of(std::FILE* file) {
  std::rewind(file);
  std::string text;
  std::array<char, 4096> buffer{};
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), file)) text.append(buffer.data(), n);
  return text;
}

/// Runs `dot -Tsvg` from one file to another; 0, or an errno.
int start_dot(std::FILE* in, std::FILE* out, pid_t& process) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, fileno(in), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, fileno(out), STDOUT_FILENO);
  std::string program = "dot", option = "-Tsvg";
  std::array<char*, 3> arguments{program.data(), option.data(), nullptr};
  const int error = posix_spawnp(&process, "dot", &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  return error;
}

/// Whether the process ended well.
bool succeeds(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) == -1) {
    if (errno != EINTR) return false;
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

std::string svg_of(const std::string& dot_text) {
  const File in = nameless_file(), out = nameless_file();
  if (std::fwrite(dot_text.data(), 1, dot_text.size(), in.get()) != dot_text.size() || std::fflush(in.get()) != 0)
    throw InputError(fmt::format("temporary file: {}, expected room for one", std::strerror(errno)));
  std::rewind(in.get());
  pid_t process = 0;
  if (const int error = start_dot(in.get(), out.get(), process); error != 0) {
    throw InputError(
        fmt::format("dot: {}, expected the program of Graphviz in PATH (apt-get install graphviz); "
                    "--dot prints the drawing as text without it",
                    std::strerror(error)));
  }
  if (!succeeds(process)) throw InputError("dot: failed, expected it to draw; --dot prints what it was given");
  return content_of(out.get());
}

}  // namespace maximin::apps
