// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__SERVICE_CALL_HPP_
#define DEROS_RUNTIME_CPP__SERVICE_CALL_HPP_

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "deros_runtime_cpp/bound_service.hpp"
#include "deros_runtime_cpp/event_loop.hpp"

namespace deros_runtime_cpp
{

/// Calls a service from a trigger of an action until it answers success, or the action is reset.
/**
 * Only answers to requests since the last trigger count: what was done before it may have been
 * undone since.
 */
class ServiceCall : public BoundService
{
public:
  /// Takes an answer: whether it is success, and the message of the server.
  using TakeAnswer = std::function<void (bool, const std::string &)>;

  /// A service and its client.
  struct Client
  {
    std::string service;
    std::function<bool()> is_available;
    std::function<void(TakeAnswer)> send;  // a request; its answer comes later, in the same thread
  };

  explicit ServiceCall(Client client, std::function<Time()> now = steady_now);

  void attach(ReportFault report_fault, ReportSuccess report_success) override;
  void set_active(bool active) override;
  void check() override;

private:
  void check_call(Time now);
  void call(Time now);
  void lose();
  void take_answer(std::uint64_t request, bool success, const std::string & message);
  void forget_requests();
  void report(const std::string & fault);

  Client client_;
  std::function<Time()> now_;
  ReportFault report_fault_;
  ReportSuccess report_success_;
  Time available_at_;
  bool is_waiting_ = false;  // for success
  std::optional<Time> sent_at_;  // the last request, if its answer is awaited
  std::uint64_t requests_ = 0;
  std::uint64_t forgotten_ = 0;  // the first requests, whose answers no longer count
  std::string answer_;  // what the last request was answered, if not success
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__SERVICE_CALL_HPP_
