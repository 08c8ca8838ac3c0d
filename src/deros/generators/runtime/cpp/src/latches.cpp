// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/latches.hpp"

#include <fcntl.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <random>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/digest.hpp"
#include "deros_runtime_cpp/regular_file.hpp"
#include "deros_runtime_cpp/text.hpp"

namespace deros_runtime_cpp
{

namespace
{

constexpr const char * HEAD = "deros latches 1";
constexpr std::size_t LONGEST = 1 << 20;  // bytes; a longer file is not a latch file
constexpr int UNIQUE = 2;  // random words in the name of a new file
constexpr std::size_t FRAME = 2;  // lines before the names; and after them, digest and end

std::system_error failure()
{
  return {errno, std::generic_category()};
}

std::vector<std::string> lines_of(const std::string & text)
{
  std::vector<std::string> lines(1);
  for (const char character : text) {
    if (character == '\n') {
      lines.emplace_back();
    } else {
      lines.back() += character;
    }
  }
  return lines;
}

/// Return the contents of a file. \throw std::system_error
std::string read(const Descriptor & file)
{
  std::string text;
  std::vector<char> buffer(4096);
  ssize_t count = 0;
  while ((count = ::read(file.get(), buffer.data(), buffer.size())) > 0) {
    text.append(buffer.data(), static_cast<std::size_t>(count));
    if (text.size() > LONGEST) {
      throw FileError("it is longer than " + std::to_string(LONGEST) + " bytes");
    }
  }
  if (count < 0) {
    throw failure();
  }
  return text;
}

/// Write a text to a file. \throw std::system_error
void write(const Descriptor & file, const std::string & text)
{
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t count = ::write(file.get(), text.data() + done, text.size() - done);
    if (count < 0) {
      throw failure();
    }
    done += static_cast<std::size_t>(count);
  }
}

void sync(const Descriptor & file)
{
  if (!file || ::fsync(file.get()) != 0) {
    throw failure();
  }
}

/// Create a folder for the user alone, if it is missing. \throw std::system_error
void make_folder(const std::filesystem::path & folder)
{
  std::error_code error;
  std::filesystem::create_directories(folder.parent_path(), error);
  if (error) {
    throw std::system_error(error);
  }
  if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) {
    throw failure();
  }
}

std::filesystem::path home()
{
  const char * folder = std::getenv("HOME");
  if (folder != nullptr) {
    return folder;
  }
  const passwd * entry = ::getpwuid(::getuid());
  return entry != nullptr ? entry->pw_dir : "/";
}

}  // namespace

std::filesystem::path default_path(const std::string & stem)
{
  const char * ros_home = std::getenv("ROS_HOME");
  const bool is_set = ros_home != nullptr && *ros_home != '\0';
  const std::filesystem::path folder = is_set ? std::filesystem::path(ros_home) : home() / ".ros";
  return folder / "deros" / (stem + ".latches");
}

LatchFile::LatchFile(std::filesystem::path path, std::string owner)
: path_(std::move(path)), owner_(std::move(owner))
{
}

LatchFile::Loaded LatchFile::load(const Names & known) const
{
  std::string text;
  try {
    const Descriptor file = open_regular(path_, O_RDONLY);
    if (!file) {
      return {{}, ""};
    }
    text = read(file);
  } catch (const std::system_error & error) {
    return {known, path_.string() + " cannot be read: " + error.what()};
  }
  std::vector<std::string> names = lines_of(text);
  if (names.size() >= 2 * FRAME) {
    names.erase(names.end() - FRAME, names.end());
    names.erase(names.begin(), names.begin() + FRAME);
  } else {
    names.clear();
  }
  if (text != text_of(names)) {
    return {known, path_.string() + " is damaged, or not of " + owner_};
  }
  const Names active(names.begin(), names.end());
  std::vector<std::string> unknown_names;
  for (const std::string & name : active) {
    if (known.count(name) == 0) {
      unknown_names.push_back(name);
    }
  }
  if (!unknown_names.empty()) {
    return {known, path_.string() + " names " + joined(unknown_names, ", ") + ", unknown by now"};
  }
  return {active, ""};
}

void LatchFile::save(const Names & active)
{
  if (contains(active)) {
    return;
  }
  saved_.reset();
  make_folder(path_.parent_path());
  check_replaceable(path_);
  write_new(new_path(), active);
  sync(Descriptor(::open(path_.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)));
  saved_ = active;
}

bool LatchFile::is_in_place() const
{
  return opened_ && is_same(path_, opened_);
}

void LatchFile::remove_leftovers() const
{
  const std::string pattern = new_path().filename().string();
  const std::string stem = path_.filename().string() + '.';
  std::error_code error;
  for (std::filesystem::directory_iterator entry(path_.parent_path(), error), end;
    !error && entry != end; entry.increment(error))
  {
    const std::string name = entry->path().filename().string();
    const bool is_new = name.size() == pattern.size() && name.compare(0, stem.size(), stem) == 0 &&
      entry->path().extension() == ".new";
    std::error_code ignored;
    if (is_new && entry->symlink_status(ignored).type() == std::filesystem::file_type::regular) {
      std::filesystem::remove(entry->path(), ignored);
    }
  }
}

/// Return the path of a temporary file, which nobody can predict.
std::filesystem::path LatchFile::new_path() const
{
  std::random_device random;
  std::ostringstream name;
  name << path_.string() << '.' << std::hex << std::setfill('0');
  for (int i = 0; i < UNIQUE; ++i) {
    name << std::setw(8) << random();
  }
  name << ".new";
  return name.str();
}

void LatchFile::write_new(const std::filesystem::path & path, const Names & active)
{
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!file) {
    throw failure();
  }
  try {
    write(file, text_of({active.begin(), active.end()}));
    sync(file);
    check_replaceable(path_);
    if (::rename(path.c_str(), path_.c_str()) != 0) {
      throw failure();
    }
  } catch (const std::system_error &) {
    ::unlink(path.c_str());
    throw;
  }
  opened_ = std::move(file);
}

void LatchFile::mark_dirty() noexcept
{
  saved_.reset();
  if (opened_) {
    // If this fails, the save that follows reports why.
    [[maybe_unused]] const ssize_t count = ::pwrite(opened_.get(), "?", 1, 0);
  }
}

void LatchFile::truncate()
{
  const Descriptor file = open_regular(path_, O_WRONLY | O_CREAT);
  if (!file || ::ftruncate(file.get(), 0) != 0) {
    throw failure();
  }
  sync(file);
}

std::string LatchFile::text_of(const std::vector<std::string> & names) const
{
  std::string body = std::string(HEAD) + '\n' + owner_ + '\n';
  for (const std::string & name : names) {
    body += name + '\n';
  }
  return body + sha256(body) + '\n';
}

Latches::Latches(LatchFile file, std::vector<std::string> known, Report report)
: file_(std::move(file)),
  known_(std::move(known)),
  active_(known_.size()),
  report_(std::move(report))
{
  file_.remove_leftovers();
  auto [active, problem] = file_.load({known_.begin(), known_.end()});
  try {
    file_.save(active);
  } catch (const std::system_error & error) {
    active = {known_.begin(), known_.end()};
    problem = file_.path().string() + " cannot be written: " + error.what();
  }
  for (std::size_t i = 0; i < known_.size(); ++i) {
    active_[i] = active.count(known_[i]) != 0;
  }
  if (!problem.empty()) {
    report_("latches", problem + "; all latched actions are active");
  }
}

LatchFile::Names Latches::active() const
{
  LatchFile::Names names;
  for (std::size_t i = 0; i < known_.size(); ++i) {
    if (active_[i]) {
      names.insert(known_[i]);
    }
  }
  return names;
}

std::string Latches::persist()
{
  const LatchFile::Names now = active();
  if (file_.contains(now)) {
    if (file_.is_in_place()) {
      return "";
    }
    file_.invalidate();  // it was removed or replaced
  }
  try {
    file_.save(now);
  } catch (const std::system_error & error) {
    std::string text = file_.path().string() + " cannot be written: " + error.what();
    try {
      file_.truncate();
      text += "; after a restart all latched actions are active";
    } catch (const std::system_error & second) {
      text += std::string("; nor emptied: ") + second.what();
    }
    report_("latches", text);
    return text;
  }
  report_("latches", "");
  return "";
}

std::string Latches::allow_reset(const LatchFile::Names & remaining)
{
  try {
    file_.save(remaining);
  } catch (const std::system_error & error) {
    persist();
    return "nothing is reset, because " + file_.path().string() + " cannot be written: " +
           error.what();
  }
  report_("latches", "");
  return "";
}

}  // namespace deros_runtime_cpp
