// Answers one line for each line of its input, so that the runtime can be asked from Python.

#include <cstdint>
#include <cstring>
#include <exception>
#include <iostream>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/descriptor.hpp"
#include "deros_runtime_cpp/instance.hpp"
#include "deros_runtime_cpp/latches.hpp"
#include "deros_runtime_cpp/digest.hpp"
#include "deros_runtime_cpp/service_call.hpp"
#include "deros_runtime_cpp/start_order.hpp"
#include "deros_runtime_cpp/text.hpp"

namespace
{

using deros_runtime_cpp::LatchFile;

std::vector<std::string> words_of(const std::string & line, char separator)
{
  std::vector<std::string> words;
  std::istringstream stream(line);
  for (std::string word; std::getline(stream, word, separator); ) {
    words.push_back(word);
  }
  return words;
}

LatchFile::Names names_of(const std::string & text)
{
  const std::vector<std::string> words = words_of(text, ',');
  return {words.begin(), words.end()};
}

std::string text_of(const LatchFile::Names & names)
{
  return deros_runtime_cpp::joined({names.begin(), names.end()}, ",");
}

std::string number(const std::string & bits)
{
  const std::uint64_t integer = std::stoull(bits, nullptr, 16);
  double value = 0.0;
  std::memcpy(&value, &integer, sizeof(value));
  return deros_runtime_cpp::to_text(value);
}

std::string single(const std::string & bits)
{
  const auto integer = static_cast<std::uint32_t>(std::stoul(bits, nullptr, 16));
  float value = 0.0F;
  std::memcpy(&value, &integer, sizeof(value));
  return deros_runtime_cpp::to_text(value);
}

std::string claimed(const std::string & folder, const std::string & domain, const std::string & name)
{
  static std::vector<deros_runtime_cpp::Descriptor> locks;
  try {
    locks.push_back(deros_runtime_cpp::claim(name, std::stoul(domain), folder));
  } catch (const std::exception & error) {
    return error.what();
  }
  return "held";
}

/// Return what a node decides, started at 0: y or n at each TIME+ with another node, TIME- without.
std::string decided(const std::string & looks)
{
  deros_runtime_cpp::StartOrder order(0);
  std::string found;
  for (const std::string & look : words_of(looks, ',')) {
    found += order.gives_way(look.back() == '+', std::stoll(look)) ? 'y' : 'n';
  }
  return found;
}

/// Return what the calls of a service do, of which each step of a script changes something.
/**
 * A step is +TIME for time that passes before a check, t for a trigger, r for a reset, a and d for a
 * server that comes and goes, and y, n or m with the number of a request for its answer.
 */
std::string called(const std::string & script)
{
  using deros_runtime_cpp::ServiceCall;
  deros_runtime_cpp::Time now = 0;
  bool is_available = false;
  std::string done;
  std::string fault;
  std::vector<ServiceCall::TakeAnswer> requests;
  ServiceCall call(
    {"/arm", [&] {return is_available;},
      [&](ServiceCall::TakeAnswer take_answer) {
        done += "call|";
        requests.push_back(std::move(take_answer));
      }},
    [&] {return now;});
  call.attach(
    [&](const std::string & text) {
      done += text == fault ? "" : "fault " + text + '|';
      fault = text;
    },
    [&](const std::string & service) {done += service + " done|";});
  for (const std::string & step : words_of(script, ',')) {
    const std::size_t number = step.size() > 1 ? std::stoul(step.substr(1)) : 0;
    switch (step.front()) {
      case '+':
        now += static_cast<deros_runtime_cpp::Time>(number);
        call.check();
        break;
      case 't':
      case 'r':
        call.set_active(step == "t");
        break;
      case 'a':
      case 'd':
        is_available = step == "a";
        break;
      default:
        requests.at(number)(step.front() == 'y', step.front() == 'm' ? "busy\n\xC3\xA9" : "");
    }
  }
  return done;
}

std::string answer(const std::vector<std::string> & words)
{
  const std::string & what = words.at(0);
  if (what == "number") {
    return number(words.at(1));
  }
  if (what == "single") {
    return single(words.at(1));
  }
  if (what == "digest") {
    return deros_runtime_cpp::sha256(words.size() > 1 ? words.at(1) : "");
  }
  if (what == "stem") {
    return deros_runtime_cpp::file_stem(words.at(1), std::stoul(words.at(2)));
  }
  if (what == "place") {
    return deros_runtime_cpp::default_path(words.at(1)).string();
  }
  if (what == "order") {
    return decided(words.at(1));
  }
  if (what == "service") {
    return called(words.at(1));
  }
  if (what == "claim") {
    return claimed(words.at(1), words.at(2), words.at(3));
  }
  LatchFile file(words.at(1), words.at(2));
  const LatchFile::Names names = names_of(words.size() > 3 ? words.at(3) : "");
  if (what == "load") {
    const LatchFile::Loaded loaded = file.load(names);
    return text_of(loaded.active) + '|' + loaded.problem;
  }
  if (what == "leftovers") {
    file.remove_leftovers();
    return "done";
  }
  try {
    file.save(names);
    if (what == "mark_dirty") {
      file.mark_dirty();
    } else if (what == "truncate") {
      file.truncate();
    }
  } catch (const std::system_error & error) {
    return error.what();
  }
  return "done";
}

}  // namespace

int main()
{
  for (std::string line; std::getline(std::cin, line); ) {
    std::cout << answer(words_of(line, '\t')) << std::endl;
  }
  return 0;
}
