// User code of an action: it does what a file says, once.

#ifndef INTERFERENCE_HPP_
#define INTERFERENCE_HPP_

#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <thread>

#include "rclcpp/rclcpp.hpp"

/// Do what the file says, and remove it, so that the next process is not affected.
inline void interfere_with(rclcpp::Node & node)
{
  const char * path = std::getenv("INTERFERENCE");
  std::ifstream file(path != nullptr ? path : "");
  if (!file) {
    return;
  }
  const std::string how{std::istreambuf_iterator<char>(file), {}};
  std::remove(path);
  RCLCPP_WARN(node.get_logger(), "interference: %s", how.c_str());
  if (how == "throw") {
    throw std::runtime_error("no horn");
  }
  if (how == "throw something else") {
    throw 42;
  }
  if (how == "exit") {
    std::exit(0);
  }
  if (how == "exit at once") {
    ::_exit(0);
  }
  if (how == "shutdown") {
    rclcpp::shutdown();
  }
  if (how == "kill") {
    ::kill(::getpid(), SIGKILL);
  }
  if (how == "who") {
    RCLCPP_INFO(
      node.get_logger(), "process %ld of user %lu", static_cast<long>(::getpid()),
      static_cast<unsigned long>(::geteuid()));
  }
  if (how == "wait") {
    while (!std::ifstream(std::string(path) + ".over")) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  if (how == "start a thread and throw") {
    std::thread([] {std::this_thread::sleep_for(std::chrono::hours(1));}).detach();
    throw std::runtime_error("no horn");
  }
}

#endif  // INTERFERENCE_HPP_
