// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/ports.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <utility>

namespace deros_runtime_cpp
{

namespace
{

constexpr std::size_t UNLIMITED = 1000;  // how many can wait with the history KEEP_ALL

std::size_t depth_of(const rclcpp::QoS & qos)
{
  const bool has_limit = qos.history() == rclcpp::HistoryPolicy::KeepLast && qos.depth() > 0;
  return has_limit ? qos.depth() : UNLIMITED;
}

}  // namespace

Ports::Ports(EventLoop & event_loop, ReportUndecodable report_undecodable)
: event_loop_(event_loop), report_undecodable_(std::move(report_undecodable))
{
}

Ports::~Ports()
{
  for (const auto & subscription : subscriptions_) {
    subscription->clear_on_new_message_callback();
  }
  for (const auto & waitable : intra_process_) {
    waitable->clear_on_ready_callback();
  }
  for (const auto & service : services_) {
    service->clear_on_new_request_callback();
  }
  for (const auto & client : clients_) {
    client->clear_on_new_response_callback();
  }
}

void Ports::serve(const rclcpp::CallbackGroup & group)
{
  group.collect_all_ptrs(
    [this](const rclcpp::SubscriptionBase::SharedPtr & each) {
      serve_messages(each);
      serve_intra_process(each);
    },
    [this](const rclcpp::ServiceBase::SharedPtr & each) {serve(each);},
    [this](const rclcpp::ClientBase::SharedPtr & each) {serve_responses(each);},
    [](const rclcpp::TimerBase::SharedPtr &) {},
    [](const rclcpp::Waitable::SharedPtr &) {});
}

void Ports::serve_messages(const rclcpp::SubscriptionBase::SharedPtr & subscription)
{
  struct Taken
  {
    std::shared_ptr<void> message;
    rclcpp::MessageInfo info;
  };
  const auto taken = std::make_shared<Taken>();
  taken->message = subscription->create_message();
  const auto take = [this, from = subscription.get(), taken] {
      try {
        if (from->take_type_erased(taken->message.get(), taken->info)) {
          from->handle_message(taken->message, taken->info);
        }
      } catch (const rclcpp::exceptions::RCLErrorBase & error) {
        report_undecodable_(from->get_topic_name(), error.message);
      }
    };
  const std::size_t source = event_loop_.add_source(take, depth_of(subscription->get_actual_qos()));
  subscription->set_on_new_message_callback(
    [this, source](std::size_t count) {event_loop_.notify(source, count);});
  subscriptions_.push_back(subscription);
}

/// Serve the messages of publishers in this process.
void Ports::serve_intra_process(const rclcpp::SubscriptionBase::SharedPtr & subscription)
{
  const rclcpp::Waitable::SharedPtr waitable = subscription->get_intra_process_waitable();
  if (!waitable) {
    return;
  }
  const auto take = [from = waitable.get()] {
      const std::shared_ptr<void> data = from->take_data();
      if (data) {
        from->execute(data);
      }
    };
  const std::size_t source = event_loop_.add_source(take, depth_of(subscription->get_actual_qos()));
  waitable->set_on_ready_callback(
    [this, source](std::size_t count, int) {event_loop_.notify(source, count);});
  intra_process_.push_back(waitable);
}

void Ports::serve(const rclcpp::ServiceBase::SharedPtr & service)
{
  const auto take = [from = service.get()] {
      const std::shared_ptr<void> request = from->create_request();
      const std::shared_ptr<rmw_request_id_t> header = from->create_request_header();
      if (from->take_type_erased_request(request.get(), *header)) {
        from->handle_request(header, request);
      }
    };
  const std::size_t source = event_loop_.add_source(take, UNLIMITED);
  service->set_on_new_request_callback(
    [this, source](std::size_t count) {event_loop_.notify(source, count);});
  services_.push_back(service);
}

void Ports::serve_responses(const rclcpp::ClientBase::SharedPtr & client)
{
  const auto take = [from = client.get()] {
      const std::shared_ptr<void> response = from->create_response();
      const std::shared_ptr<rmw_request_id_t> header = from->create_request_header();
      if (from->take_type_erased_response(response.get(), *header)) {
        from->handle_response(header, response);
      }
    };
  const std::size_t source = event_loop_.add_source(take, UNLIMITED);
  client->set_on_new_response_callback(
    [this, source](std::size_t count) {event_loop_.notify(source, count);});
  clients_.push_back(client);
}

}  // namespace deros_runtime_cpp
