// The direction of the house: python -> apps -> eval, simulator, estimator -> core. Reads every source of the
// tree; the checker itself is tested on samples that break each rule.

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fs = std::filesystem;

namespace {

using Libraries = std::set<std::string>;

const std::map<std::string, Libraries> kMayInclude{
    {"core", {"core"}},
    {"simulator", {"core", "simulator"}},
    {"estimator", {"core", "estimator"}},
    {"eval", {"core", "eval"}},
    {"apps", {"core", "simulator", "estimator", "eval", "apps"}},
    {"python", {"core", "simulator", "estimator", "eval", "apps", "python"}},
    {"tests", {"core", "simulator", "estimator", "eval", "apps", "tests"}},
};

struct Include {
  int line;
  bool quoted;
  std::string path;
};

std::vector<Include> read_includes(const std::string& text) {
  std::vector<Include> includes;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    std::string directive, path;
    words >> directive >> path;
    if (directive == "#") {
      directive += path;
      words >> path;
    } else if (const std::size_t open = directive.find_first_of("\"<"); open != std::string::npos) {
      path = directive.substr(open);
      directive.resize(open);
    }
    if (directive != "#include" || path.size() < 2) continue;
    includes.push_back({number, path.front() == '"', path.substr(1, path.find_last_of("\">") - 1)});
  }
  return includes;
}

std::string library_of(const fs::path& path) { return path.begin()->string(); }

/// What is wrong with the includes of the file `path` (relative to the root), one line each.
/// `has_header`: a .cpp has a .h of the same name beside it.
std::vector<std::string> check_source(const fs::path& path, const std::string& text,
                                      bool has_header) {
  std::vector<std::string> errors;
  const auto report = [&](int line, const std::string& what) {
    errors.push_back(path.string() + ":" + std::to_string(line) + ": " + what);
  };
  const std::string library = library_of(path);
  const std::vector<Include> includes = read_includes(text);
  for (const Include& include : includes) {
    const std::string target = library_of(include.path);
    if (!kMayInclude.contains(target)) {
      if (include.quoted) {
        report(include.line, "\"" + include.path + "\" is not written from the root");
      }
    } else if (!kMayInclude.at(library).contains(target)) {
      report(include.line, library + " must not include " + target + " (" + include.path + ")");
    }
  }
  const std::string own = fs::path(path).replace_extension(".h").generic_string();
  if (has_header && (includes.empty() || includes.front().path != own)) {
    report(includes.empty() ? 1 : includes.front().line,
           "\"" + own + "\" comes first, which shows that the header stands alone");
  }
  return errors;
}

/// The types that a header defines at its outermost level, with the first namespace that it opens.
std::vector<std::string> defined_types(const std::string& text) {
  static const std::regex kNamespace(R"(^namespace ([A-Za-z0-9_:]+) \{)");
  static const std::regex kType(
      R"(^(?:struct|class) (?:alignas\([^)]*\) )?([A-Za-z0-9_]+)(?: final)?(?: :[^:;]*)?\s*(?:\{.*)?$)");
  std::vector<std::string> types;
  std::istringstream lines(text);
  std::string line, space;
  std::smatch match;
  while (std::getline(lines, line)) {
    if (space.empty() && std::regex_search(line, match, kNamespace)) space = match[1];
    if (std::regex_search(line, match, kType)) types.push_back(space + "::" + match[1].str());
  }
  return types;
}

std::string read_text(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::vector<fs::path> find_sources(const fs::path& root) {
  std::vector<fs::path> sources;
  for (const auto& [library, allowed] : kMayInclude) {
    if (!fs::exists(root / library)) continue;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / library)) {
      const fs::path relative = entry.path().lexically_relative(root);
      const fs::path extension = relative.extension();
      // The outside project of the package test sees installed headers, like any user.
      const bool is_outside = relative.generic_string().starts_with("tests/package/");
      if ((extension == ".h" || extension == ".cpp") && !is_outside) sources.push_back(relative);
    }
  }
  std::sort(sources.begin(), sources.end());
  return sources;
}

/// A line without its comment, what its strings hold, and the names of suite and test: what a file
/// uses. Empty for directives.
std::string code_of(const std::string& line) {
  const std::size_t first = line.find_first_not_of(' ');
  if (first == std::string::npos || line[first] == '#') return "";
  std::string code;
  bool in_text = false;
  std::size_t i = line.starts_with("TEST") ? std::min(line.find(')'), line.size()) : first;
  for (; i < line.size(); ++i) {
    if (in_text && line[i] == '\\') {
      ++i;
    } else if (line[i] == '"') {
      in_text = !in_text;
      code += ' ';
    } else if (!in_text) {
      if (line.compare(i, 2, "//") == 0) break;
      code += line[i];
    }
  }
  return code;
}

struct Names {
  std::set<std::string> used;      ///< beginning with a capital, as types do
  std::set<std::string> declared;  ///< in whatever scope
};

/// Members and what other libraries or types hold (`.X`, `->X`, `A::X`) are not used by that name.
Names names_in(const std::string& text) {
  const auto is_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
  };
  static const std::set<std::string> kDeclaring{"struct", "class", "enum", "using", "typename"};
  Names names;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::string code = code_of(line);
    std::string before, word;
    for (std::size_t i = 0; i < code.size(); i += std::max<std::size_t>(1, word.size())) {
      word.clear();
      for (std::size_t k = i; k < code.size() && is_word(code[k]); ++k) word += code[k];
      if (word.empty()) continue;
      const bool is_inner =
          i > 0 && (code[i - 1] == '.' || code[i - 1] == '>' || code[i - 1] == ':');
      const bool is_ours =
          code.substr(0, i).ends_with("testing::") || code.substr(0, i).ends_with("saccade::");
      if (kDeclaring.contains(before)) names.declared.insert(word);
      if (std::isupper(static_cast<unsigned char>(word[0])) && (!is_inner || is_ours))
        names.used.insert(word);
      before = word;
    }
  }
  return names;
}

struct Sample {
  const char* path;
  const char* text;
  bool has_header;
  const char* error;  ///< part of the message; empty: the sample is allowed
};

class LayeringChecker : public ::testing::TestWithParam<Sample> {};

TEST_P(LayeringChecker, JudgesSample) {
  const Sample& sample = GetParam();
  const std::vector<std::string> errors = check_source(sample.path, sample.text, sample.has_header);
  if (*sample.error == '\0') {
    EXPECT_TRUE(errors.empty()) << errors.front();
  } else {
    ASSERT_EQ(errors.size(), 1U);
    EXPECT_NE(errors.front().find(sample.error), std::string::npos) << errors.front();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Samples, LayeringChecker,
    ::testing::Values(
        Sample{"core/a.h", "#include <vector>\n#include \"core/event.h\"\n", false, ""},
        Sample{"apps/main.cpp", "#include \"eval/a.h\"\n", false, ""},
        Sample{"python/binding/a.cpp", "#include \"simulator/a.h\"\n", false, ""},
        Sample{"tests/unit/core/a_test.cpp", "#include \"tests/support/b.h\"\n", false, ""},
        Sample{"core/a.h", "\n#include \"simulator/a.h\"\n", false,
               "core/a.h:2: core must not include simulator"},
        Sample{"simulator/a.cpp", "#include \"estimator/a.h\"\n", false,
               "simulator must not include estimator"},
        Sample{"estimator/a.cpp", "  #  include <eval/a.h>\n", false,
               "estimator must not include eval"},
        Sample{"eval/a.cpp", "#include\"simulator/a.h\" // why\n", false,
               "eval must not include simulator"},
        Sample{"eval/a.cpp", "#include \"apps/a.h\"\n", false, "eval must not include apps"},
        Sample{"apps/a.cpp", "#include \"python/binding/a.h\"\n", false,
               "apps must not include python"},
        Sample{"apps/a.cpp", "#include \"tests/support/a.h\"\n", false,
               "apps must not include tests"},
        Sample{"core/a.cpp", "#include \"event.h\"\n", false, "not written from the root"},
        Sample{"core/a.cpp", "#include \"../core/event.h\"\n", false, "not written from the root"},
        Sample{"core/a.cpp", "#include \"core/a.h\"\n", true, ""},
        Sample{"core/a.cpp", "#include <vector>\n#include \"core/a.h\"\n", true,
               "core/a.cpp:1: \"core/a.h\" comes first"}));

TEST(Layering, EveryIncludeFollowsTheDirection) {
  const fs::path root = SACCADE_SOURCE_DIR;
  const std::vector<fs::path> sources = find_sources(root);
  ASSERT_FALSE(sources.empty()) << "no sources below " << root;
  for (const fs::path& source : sources) {
    const bool has_header =
        source.extension() == ".cpp" && fs::exists(root / fs::path(source).replace_extension(".h"));
    for (const std::string& error : check_source(source, read_text(root / source), has_header)) {
      ADD_FAILURE() << error;
    }
  }
}

TEST(DefinedTypes, AreThoseOfTheOutermostLevelThatAreNotOnlyDeclared) {
  const std::vector<std::string> types = defined_types(
      "namespace saccade {\nclass Later;\nstruct A {\n  struct Inner {\n  };\n};\n"
      "class B : public A {\n};\nstruct alignas(32) C {\n};\n}  // namespace saccade\n");
  const std::vector<std::string> expected{"saccade::A", "saccade::B", "saccade::C"};
  EXPECT_EQ(types, expected);
}

// All libraries are linked into one program: of two types of one name the linker would keep one's
// functions for both.
TEST(Layering, EveryTypeHasANameOfItsOwn) {
  const fs::path root = SACCADE_SOURCE_DIR;
  std::map<std::string, fs::path> where;
  for (const fs::path& source : find_sources(root)) {
    if (source.extension() != ".h" || library_of(source) == "tests") continue;
    for (const std::string& type : defined_types(read_text(root / source))) {
      const auto [first, is_new] = where.emplace(type, source);
      EXPECT_TRUE(is_new) << type << " in " << source << " and " << first->second;
    }
  }
  EXPECT_GT(where.size(), 100U);
}

TEST(NamesIn, AreThoseOfTheCodeAlone) {
  const Names names = names_in(
      "#include <Eigen/Cholesky>\nTEST(Suite, Name) { Used x(\"Text \\\" Text\"); }  // Comment\n"
      "struct Own {};\nEigen::Other y = a.Member + b->Member;\nsaccade::Ours z;\n");
  EXPECT_EQ(names.used, (std::set<std::string>{"Eigen", "Ours", "Own", "Used"}));
  EXPECT_EQ(names.declared, std::set<std::string>{"Own"});
}

// Where a folder is compiled as one unit the compiler does not see that a file relies on the
// includes of its neighbours.
TEST(Layering, EveryFileReachesTheTypesThatItNames) {
  const fs::path root = SACCADE_SOURCE_DIR;
  std::map<std::string, std::string> header_of;
  std::map<std::string, Names> names;
  std::map<std::string, std::vector<Include>> includes;
  for (const fs::path& source : find_sources(root)) {
    const std::string text = read_text(root / source), path = source.generic_string();
    names[path] = names_in(text);
    includes[path] = read_includes(text);
    if (source.extension() == ".h")
      for (const std::string& type : defined_types(text))
        header_of[type.substr(type.rfind(':') + 1)] = path;
  }
  for (const auto& [path, own] : names) {
    std::vector<std::string> reached{path};
    std::set<std::string> seen{path}, declared;
    for (std::size_t i = 0; i < reached.size(); ++i) {
      declared.insert(names[reached[i]].declared.begin(), names[reached[i]].declared.end());
      for (const Include& include : includes[reached[i]])
        if (seen.insert(include.path).second) reached.push_back(include.path);
    }
    for (const std::string& name : own.used)
      if (const auto header = header_of.find(name);
          header != header_of.end() && !seen.contains(header->second) && !declared.contains(name))
        ADD_FAILURE() << path << ": " << name << " is from \"" << header->second
                      << "\", which it does not include";
  }
}

}  // namespace
