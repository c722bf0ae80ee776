#include "core/config/yaml_emit.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace saccade::config {
namespace {

/// Text that every YAML reader takes for the same text without quotes: a word or a path.
bool is_safe_plain(std::string_view text) {
  static constexpr std::array<std::string_view, 9> kWords{"true", "false", "null", "yes", "no",
                                                          "on",   "off",   "y",    "n"};
  if (text.empty()) return false;
  std::string lower;
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (u >= 0x80 || (!std::isalnum(u) && std::string_view("_./-").find(c) == std::string::npos))
      return false;
    lower += static_cast<char>(std::tolower(u));
  }
  const char first = text.front();
  const bool starts_as_word = std::isalpha(static_cast<unsigned char>(first)) || first == '_' ||
                              (first == '/' && text.size() > 1);
  return starts_as_word && std::find(kWords.begin(), kWords.end(), lower) == kWords.end();
}

/// Plain text as the input had it (a number, a word) that stays the same in every context.
bool is_one_word(std::string_view text) {
  const auto is_word_part = [](unsigned char c) {
    return c < 0x80 && (std::isalnum(c) || std::string_view("_.+-").find(static_cast<char>(c)) !=
                                               std::string_view::npos);
  };
  return !text.empty() && text != "-" && text.find("---") != 0 && text.find("...") != 0 &&
         std::all_of(text.begin(), text.end(), is_word_part);
}

std::string in_quotes(std::string_view text) {
  static constexpr std::string_view kHex = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += {'\\', c};
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (u < 0x20 || u == 0x7f) {
      out += {'\\', 'x', kHex[u >> 4U], kHex[u & 15U]};
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string scalar_text(const Node& node) {
  if (node.kind == Node::Kind::kNull) return "~";
  // What is printed plain is read again as unquoted, and has to be printed the same then.
  if (is_safe_plain(node.text) || (!node.quoted && is_one_word(node.text))) return node.text;
  return in_quotes(node.text);
}

std::string key_text(const Entry& entry) {
  return is_safe_plain(entry.key) ? entry.key : in_quotes(entry.key);
}

bool is_leaf(const Node& node) {
  return node.kind == Node::Kind::kNull || node.kind == Node::Kind::kScalar;
}

/// Lists without maps inside stand on one line, as do empty maps.
bool is_inline(const Node& node) {
  if (node.kind == Node::Kind::kMap) return node.entries.empty();
  if (node.kind == Node::Kind::kList)
    return std::all_of(node.items.begin(), node.items.end(), is_leaf);
  return true;
}

class Emitter {
 public:
  explicit Emitter(bool comments) : comments_(comments) {}

  std::string take() { return std::move(out_); }

  void block(const Node& node, std::size_t indent) {
    if (node.kind == Node::Kind::kMap) {
      for (const Entry& entry : node.entries) {
        begin_line(indent);
        key(entry, indent);
      }
    } else {
      for (const Node& item : node.items) {
        begin_line(indent);
        out_ += "- ";
        // The first key of a map stands behind the dash.
        fresh_ = !is_inline(item);
        if (fresh_) {
          block(item, indent + 2);
        } else {
          flow(item);
          end_line({}, {});
        }
      }
    }
  }

  void flow(const Node& node) {
    if (node.kind == Node::Kind::kMap) {
      out_ += "{";
      for (std::size_t i = 0; i < node.entries.size(); ++i) {
        out_ += (i > 0 ? ", " : "") + key_text(node.entries[i]) + ": ";
        flow(node.entries[i].value);
      }
      out_ += "}";
    } else if (node.kind == Node::Kind::kList) {
      out_ += "[";
      for (std::size_t i = 0; i < node.items.size(); ++i) {
        if (i > 0) out_ += ", ";
        flow(node.items[i]);
      }
      out_ += "]";
    } else {
      out_ += scalar_text(node);
    }
  }

 private:
  void begin_line(std::size_t indent) {
    if (!fresh_) out_.append(indent, ' ');
    fresh_ = false;
  }

  void key(const Entry& entry, std::size_t indent) {
    out_ += key_text(entry) + ":";
    if (is_inline(entry.value)) {
      out_ += " ";
      flow(entry.value);
      end_line(entry.comment, entry.rules);
    } else {
      end_line(entry.comment, entry.rules);
      block(entry.value, indent + 2);
    }
  }

  void end_line(const std::string& comment, const std::string& rules) {
    if (comments_ && !comment.empty()) out_ += "  # " + comment;
    if (comments_ && !rules.empty()) out_ += " [" + rules + "]";
    out_ += "\n";
  }

  bool comments_;
  bool fresh_ = false;  ///< the line has begun already, behind a dash
  std::string out_;
};

}  // namespace

std::string to_yaml(const Node& node, bool comments) {
  Emitter emitter(comments);
  if (is_inline(node)) {
    emitter.flow(node);
    return emitter.take() + "\n";
  }
  emitter.block(node, 0);
  return emitter.take();
}

std::string to_flow_yaml(const Node& node) {
  Emitter emitter(false);
  emitter.flow(node);
  return emitter.take();
}

}  // namespace saccade::config
