#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace saccade::config {

/// The folder that holds configs/, scenes/ and examples/ as this program was shipped with them:
/// share/saccade where it is installed, else the root of the tree that it was built in. Searched
/// upwards from the file of the program (of the module, within Python). Empty where there is none.
[[nodiscard]] const std::filesystem::path& shipped_folder();

/// Names of the shipped configurations, sorted: paths below configs/ without ".yaml", such as
/// "simulation/walls".
[[nodiscard]] std::vector<std::string> shipped_configurations();

/// The shipped file of a name: "walls", "simulation/walls" and "configs/simulation/walls.yaml" all
/// name one, as does "examples/external/constant_velocity.yaml". nullopt where nothing has this
/// name. Throws InputError that lists them where several shipped configurations have it.
[[nodiscard]] std::optional<std::filesystem::path> find_shipped(const std::filesystem::path& name);

/// The file that a user who wrote `stated` means: `stated` itself where such a file exists, else
/// the shipped one of this name, else `stated` as it is. Throws as find_shipped().
[[nodiscard]] std::filesystem::path find_configuration(const std::filesystem::path& stated);

/// "; did you mean 'walls'?", with the shipped configuration nearest to a file that does not exist;
/// empty where none is near. Where the shipped folder is not found it says so.
[[nodiscard]] std::string nearest_shipped(const std::filesystem::path& stated);

}  // namespace saccade::config
