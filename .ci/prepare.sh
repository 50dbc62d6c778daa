# Shared by bench/run, verify/run and .ci/run, which source it: installs what is missing and builds what is out of date.
# What it says goes to standard error, since standard output belongs to the program that is run afterwards; what its tools say goes
# to logs in build/.
set -euo pipefail
root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")

# log_of <name>: an empty log.
log_of() {
  mkdir -p "$root/build"
  : >"$root/build/$1.log"
  echo "$root/build/$1.log"
}

# failed_by <what> <log>: says so with the part of the log that shows why. Returns 1.
failed_by() {
  echo "$1 failed; the end of $2:" >&2
  if grep -q '^FAILED:' "$2"; then sed -n '/^FAILED:/,$p' "$2" | head -n 150; else tail -n 40 "$2"; fi >&2
  return 1
}

# install_packages <command>...: installs the packages in .ci/packages that these commands need and that are not there.
install_packages() {
  local wanted installed missing as_root=()
  wanted=$(awk -v commands=" $* " '!/^#/ && index(commands, " " $2 " ") { print $1 }' "$root/.ci/packages" | LC_ALL=C sort)
  # shellcheck disable=SC2086  # one argument for each package
  installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' $wanted 2>/dev/null | sed -n 's/^installed //p' | LC_ALL=C sort -u) || true
  mapfile -t missing < <(LC_ALL=C comm -23 <(echo "$wanted") <(echo "$installed"))
  [[ ${#missing[@]} -gt 0 ]] || return 0

  local log
  log=$(log_of install)
  echo "installing ${#missing[@]} packages and what they need; log: $log" >&2
  if [[ $EUID -ne 0 ]]; then
    as_root=(sudo -n)
    if ! "${as_root[@]}" true; then
      echo "this needs root or sudo without a password; by hand: apt-get install --no-install-recommends ${missing[*]}" >&2
      return 1
    fi
  fi
  {
    echo "installing: ${missing[*]}"
    "${as_root[@]}" apt-get update -qq &&
      "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -qq --no-install-recommends -o Dpkg::Use-Pty=0 \
        -o DPkg::Lock::Timeout=300 "${missing[@]}" </dev/null
  } >"$log" 2>&1 || failed_by "installing" "$log"
}

# show_progress <log>: keeps what ninja says in a log, and shows how far it is: in one line on a terminal, else only that it builds.
# Not by awk: Debian's mawk waits for 4 KB of input.
show_progress() {
  local line said=
  while IFS= read -r line || [[ -n $line ]]; do
    echo "$line" >>"$1"
    [[ $line =~ ^(\[[0-9]+/[0-9]+\])\ (Building|Linking) ]] || continue
    if [[ -t 2 ]]; then
      printf '\r\033[Kbuilding %s; log: %s' "${BASH_REMATCH[1]}" "$1"
    elif [[ -z $said ]]; then
      echo "building; log: $1"
    fi
    said=yes
  done
  if [[ -t 2 && -n $said ]]; then printf '\r\033[K'; fi
} >&2

# build <preset> [cmake --build option]...: configures if that was never done or the presets changed, and builds. Silent if there
# is nothing to do.
build() {
  local directory=$root/build/$1 log
  log=$(log_of "$1")
  if [[ ! $directory/build.ninja -nt $root/CMakePresets.json ]]; then
    (cd "$root" && cmake --preset "$1") >"$log" 2>&1 || failed_by "configuring" "$log" || return
  fi
  cmake --build "$directory" --parallel "$(nproc)" "${@:2}" 2>&1 | show_progress "$log" || failed_by "building" "$log"
}

# run_tests <preset> [GoogleTest option]...: in eight parts, as many at a time as there are cores; not by ctest, which would start the
# program again for each of some two thousand tests.
run_tests() {
  local status=0
  seq 0 7 | GTEST_TOTAL_SHARDS=8 xargs -P "$(nproc)" -I '{}' env GTEST_SHARD_INDEX='{}' \
    timeout 1200 "$root/build/$1/verify/verify" --gtest_brief=1 "${@:2}" | sed -u '/: Skipped$/,+1d' | tee "$root/build/tests.log" || status=$?
  [[ $(grep -c 'tests\? from .* ran' "$root/build/tests.log") -eq 8 ]] || status=1  # a program that ends before its tests has passed none
  [[ $status -eq 0 ]] && echo "all tests passed" || echo "tests failed"
  return "$status"
}
