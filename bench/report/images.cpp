#include "bench/report/images.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>

#include "bench/report/base64.hpp"
#include "bench/report/browser.hpp"
#include "bench/runs/interruption.hpp"
#include "solver/base/atomic_file.hpp"
#include "solver/base/temporary.hpp"

namespace drape::bench {
namespace {

namespace fs = std::filesystem;

Browsed draw(const fs::path& page) {
  try {
    return browse(fs::absolute(page), "see(JSON.stringify(await report.allPictures()));", 1280);
  } catch (const std::system_error& error) {
    check_interruption();
    if (error.code() == std::errc::no_such_file_or_directory)
      throw std::invalid_argument(
          "--images: there is no chromium on the PATH: install the Debian package chromium (apt-get install chromium)");
    if (error.code() == std::errc::timed_out)
      throw std::runtime_error(fmt::format("--images: Chromium has not drawn the figures of {} in {:g} s and was ended",
                                           page.string(), browsing_time));
    throw;
  }
}

nlohmann::json pictures_of(const fs::path& page) {
  const Browsed drawn = draw(page);
  if (drawn.seen.starts_with('[')) return nlohmann::json::parse(drawn.seen);
  throw std::runtime_error(fmt::format("--images: Chromium has not drawn the figures of {}{}{}", page.string(),
                                       drawn.console.empty() ? "" : ": ", drawn.console.empty() ? "" : drawn.console.front()));
}

/// Whatever else is in the folder would be lost.
void require_only_pictures(const fs::path& folder) {
  std::error_code missing;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, missing))
    if (!entry.is_regular_file() || (entry.path().extension() != ".svg" && entry.path().extension() != ".png"))
      throw base::FileError(fmt::format("{}: expected nothing but older pictures in {}, which is replaced",
                                        entry.path().string(), folder.string()));
}

void write(const fs::path& file, std::span<const std::byte> bytes) { base::publish(file, bytes, base::Existing::refuse); }

}  // namespace

std::size_t write_images(const fs::path& page, const fs::path& folder) {
  require_only_pictures(folder);
  const nlohmann::json pictures = pictures_of(page);
  const base::TemporaryFolder made(page.parent_path());  // in the same file system, so that a rename does
  base::create_folder(made / "new");
  for (const nlohmann::json& picture : pictures) {
    const std::string stem = "new/" + picture.at("name").get<std::string>(), svg = picture.at("svg");
    write(made / (stem + ".svg"), std::as_bytes(std::span(svg)));
    write(made / (stem + ".png"), bytes_of_base64(picture.at("png").get<std::string>()));
  }
  if (fs::exists(folder)) fs::rename(folder, made / "old");
  fs::rename(made / "new", folder);
  return pictures.size();
}

}  // namespace drape::bench
