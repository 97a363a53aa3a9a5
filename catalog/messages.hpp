#pragma once
// Messages by identifier (rows of messages/*.toml), and the exception that carries one.
#include <initializer_list>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace lacon {

/// A message whose gaps are filled in.
struct Message {
  char severity;  ///< F fatal, S the solution failed, A alarm, I information
  std::string id;
  std::string text;
  std::string advice;  ///< what to do
};

/// What fills a gap `{name}` of a message's text.
using MessageValue = std::pair<std::string_view, std::string>;

/// The message `id` of the catalogue with its gaps filled. An identifier or a gap that does not exist is a defect:
/// std::logic_error.
Message message(std::string_view id, std::initializer_list<MessageValue> values = {});

/// Thrown for every error of the user (F) and every failure of the solution (S).
class Error : public std::runtime_error {
 public:
  explicit Error(Message message) : std::runtime_error(message.text), message_(std::move(message)) {}
  const Message& message() const { return message_; }

 private:
  Message message_;
};

/// Throw the message `id`.
[[noreturn]] void fail(std::string_view id, std::initializer_list<MessageValue> values = {});

/// Where alarms and information go; an operator's program prints and counts them, a test may collect them.
using MessageSink = void (*)(const Message&);
void set_message_sink(MessageSink sink);

/// Send an alarm (A) or an information (I) to the sink.
void inform(std::string_view id, std::initializer_list<MessageValue> values = {});
void inform(const Message& said);

}  // namespace lacon

namespace lacon::catalog {

struct MessageRow {
  std::string_view id;
  char severity;
  std::string_view text;
  std::string_view advice;
};

std::span<const MessageRow> messages();

}  // namespace lacon::catalog
