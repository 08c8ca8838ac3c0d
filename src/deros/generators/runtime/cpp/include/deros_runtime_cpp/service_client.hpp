// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__SERVICE_CLIENT_HPP_
#define DEROS_RUNTIME_CPP__SERVICE_CLIENT_HPP_

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "deros_runtime_cpp/bound_service.hpp"
#include "deros_runtime_cpp/service_call.hpp"
#include "rclcpp/rclcpp.hpp"

namespace deros_runtime_cpp
{

/// The time for which the answer to a request still counts.
constexpr std::chrono::seconds KEPT{10};

/// Return the message of a response, if it has one.
template<typename ResponseT>
auto message_of(const ResponseT & response, int /*preferred*/)
-> decltype(std::string(response.message))
{
  return response.message;
}

template<typename ResponseT>
std::string message_of(const ResponseT & /*response*/, ...)
{
  return "";
}

/// Sets the fields of a request; it may be empty.
template<typename ServiceT>
using FillRequest = std::function<void (typename ServiceT::Request &)>;

/// Return the calls of a service by its client, with the request that a function fills in.
template<typename ServiceT>
std::shared_ptr<BoundService> service_call(
  const typename rclcpp::Client<ServiceT>::SharedPtr & client,
  const FillRequest<ServiceT> & fill = {})
{
  const auto request = std::make_shared<typename ServiceT::Request>();
  if (fill) {
    fill(*request);
  }
  const auto send = [client, request](ServiceCall::TakeAnswer take_answer) {
      client->prune_requests_older_than(std::chrono::system_clock::now() - KEPT);
      client->async_send_request(
        request,
        [take_answer = std::move(take_answer)](
          typename rclcpp::Client<ServiceT>::SharedFuture answered) {
          const auto response = answered.get();
          take_answer(response->success, message_of(*response, 0));
        });
    };
  return std::make_shared<ServiceCall>(
    ServiceCall::Client{
      client->get_service_name(), [client] {return client->service_is_ready();}, send});
}

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__SERVICE_CLIENT_HPP_
