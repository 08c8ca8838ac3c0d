// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/service_call.hpp"

#include <cstddef>
#include <string>
#include <utility>

namespace deros_runtime_cpp
{

namespace
{

constexpr Time LATE = 100'000'000;  // ns without an answer after which this is a fault
constexpr Time TIMEOUT = 1'000'000'000;  // ns without an answer until the service is called again
constexpr Time ABSENCE = 5'000'000'000;  // ns for which an idle service may be unavailable
constexpr std::size_t SHOWN = 60;  // characters of the message of an answer

/// Return the message of an answer on one line, shortened, behind a colon.
std::string shown(const std::string & message)
{
  std::string text;
  std::size_t characters = 0;
  for (const char each : message) {
    const auto byte = static_cast<unsigned char>(each);
    const bool continues = (byte & 0xC0U) == 0x80U;  // a character in UTF-8
    if (!continues && ++characters > SHOWN) {
      break;
    }
    text += byte < 0x20U || byte == 0x7FU ? '?' : each;
  }
  return text.empty() ? "" : ": " + text;
}

}  // namespace

ServiceCall::ServiceCall(Client client, std::function<Time()> now)
: client_(std::move(client)), now_(std::move(now)), available_at_(now_())
{
}

void ServiceCall::attach(ReportFault report_fault, ReportSuccess report_success)
{
  report_fault_ = std::move(report_fault);
  report_success_ = std::move(report_success);
}

void ServiceCall::set_active(bool active)
{
  forget_requests();
  is_waiting_ = active;
  if (active) {
    call(now_());
  } else {
    report("");
  }
}

void ServiceCall::check()
{
  const Time now = now_();
  if (is_waiting_) {
    check_call(now);
    return;
  }
  if (client_.is_available()) {
    available_at_ = now;
  }
  report(now - available_at_ >= ABSENCE ? "is not available" : "");
}

void ServiceCall::check_call(Time now)
{
  if (!sent_at_) {
    call(now);
  } else if (!client_.is_available()) {
    lose();
  } else if (now - *sent_at_ >= TIMEOUT) {
    answer_.clear();
    call(now);
    report("has not answered");
  } else if (now - *sent_at_ >= LATE && answer_.empty()) {
    report("has not answered");
  }
}

void ServiceCall::call(Time now)
{
  if (!client_.is_available()) {
    lose();
    return;
  }
  sent_at_ = now;
  ++requests_;
  client_.send(
    [this, request = requests_](bool success, const std::string & message) {
      take_answer(request, success, message);
    });
}

/// Report that nothing can be called; it is called as soon as it is available.
void ServiceCall::lose()
{
  sent_at_.reset();
  answer_.clear();
  report("is not available");
}

void ServiceCall::take_answer(std::uint64_t request, bool success, const std::string & message)
{
  if (request <= forgotten_) {
    return;
  }
  if (success) {
    forget_requests();
    is_waiting_ = false;
    report("");
    report_success_(client_.service);
    return;
  }
  sent_at_.reset();
  answer_ = "has answered no success" + shown(message);
  report(answer_);
}

void ServiceCall::forget_requests()
{
  forgotten_ = requests_;
  sent_at_.reset();
  answer_.clear();
}

void ServiceCall::report(const std::string & fault)
{
  report_fault_(fault.empty() ? "" : client_.service + ' ' + fault);
}

}  // namespace deros_runtime_cpp
