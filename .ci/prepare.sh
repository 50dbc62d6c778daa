# Shared by bench/run, verify/run and .ci/run, which source it: installs what is missing and builds what is out of date.
# All that it says goes to standard error: standard output belongs to the program that is run afterwards.
set -euo pipefail
root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")

# install_packages <command>...: installs the packages in .ci/packages that these commands need and that are not there.
install_packages() {
  local wanted installed missing as_root=()
  wanted=$(awk -v commands=" $* " '!/^#/ && index(commands, " " $2 " ") { print $1 }' "$root/.ci/packages" | LC_ALL=C sort)
  # shellcheck disable=SC2086  # one argument for each package
  installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' $wanted 2>/dev/null | sed -n 's/^installed //p' | LC_ALL=C sort -u) || true
  mapfile -t missing < <(LC_ALL=C comm -23 <(echo "$wanted") <(echo "$installed"))
  [[ ${#missing[@]} -gt 0 ]] || return 0

  echo "installing: ${missing[*]}" >&2
  if [[ $EUID -ne 0 ]]; then
    as_root=(sudo -n)
    if ! "${as_root[@]}" true; then
      echo "this needs root or sudo without a password; by hand: apt-get install --no-install-recommends ${missing[*]}" >&2
      return 1
    fi
  fi
  "${as_root[@]}" apt-get update -qq >&2
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -qq --no-install-recommends -o Dpkg::Use-Pty=0 \
    -o DPkg::Lock::Timeout=300 "${missing[@]}" </dev/null >&2
}

# build <preset> [cmake --build option]...: configures if that was never done or the presets changed, and builds. Silent if there
# is nothing to do.
build() {
  local directory=$root/build/$1
  if [[ ! $directory/build.ninja -nt $root/CMakePresets.json ]]; then
    (cd "$root" && cmake --preset "$1") >&2 || return
  fi
  cmake --build "$directory" --parallel "$(nproc)" "${@:2}" |
    sed -u '/Re-checking globbed directories/d; /Looking up the git commit/d; /no work to do/d' >&2
}

# run_tests <preset> [GoogleTest option]...: in four parts, as many at a time as there are cores; not by ctest, which would start the
# program anew for each of some two thousand tests.
run_tests() {
  local status=0
  seq 0 3 | GTEST_TOTAL_SHARDS=4 xargs -P "$(nproc)" -I '{}' env GTEST_SHARD_INDEX='{}' \
    timeout 1200 "$root/build/$1/verify/verify" --gtest_brief=1 "${@:2}" || status=$?
  [[ $status -eq 0 ]] && echo "all tests passed" || echo "tests failed"
  return "$status"
}
