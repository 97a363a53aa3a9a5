# shellcheck shell=bash
# What demo and check share: packages, configuring, building. To be sourced.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

say() { printf '\n== %s\n' "$*"; }

stop() {
  printf 'error: %s\n' "$*" >&2
  exit 1
}

# The names in packages.txt.
package_names() { sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$root/commands/packages.txt"; }

# The names that dpkg does not know as installed. A nodejs that is not Debian's brings npm itself, and Debian's does not go beside it.
missing_packages() {
  local name
  for name in $(package_names); do
    [[ $(dpkg-query -W -f='${db:Status-Status}' "$name" 2>/dev/null) == installed ]] && continue
    [[ $name == npm ]] && command -v npm >/dev/null && continue
    echo "$name"
  done
}

# Run apt-get as root, through sudo where we are not root.
apt_get() {
  if [[ $(id -u) == 0 ]]; then
    DEBIAN_FRONTEND=noninteractive apt-get -q -y "$@"
  else
    sudo DEBIAN_FRONTEND=noninteractive apt-get -q -y "$@"
  fi
}

# Nothing is asked of the network where nothing is missing.
install_packages() {
  if ! command -v dpkg-query >/dev/null; then
    local tool
    for tool in cmake ninja g++ python3; do
      command -v "$tool" >/dev/null || stop "$tool is missing, and this is no Debian: install what stands for the packages of commands/packages.txt"
    done
    return
  fi
  local missing name
  mapfile -t missing < <(missing_packages)
  ((${#missing[@]})) || return 0
  say "Missing packages: ${missing[*]}"
  [[ $(id -u) == 0 ]] || command -v sudo >/dev/null ||
    stop "these packages are missing and neither root nor sudo is at hand: ask for  apt-get install ${missing[*]}"
  for name in "${missing[@]}"; do
    if ! apt-cache show "$name" >/dev/null 2>&1; then # no list of packages yet, or an old one
      apt_get update || stop "apt-get update fails: the package $name cannot be found"
      break
    fi
  done
  if ! apt_get install --no-install-recommends "${missing[@]}"; then
    apt_get update || stop "apt-get update fails: ${missing[*]} cannot be installed"
    apt_get install --no-install-recommends "${missing[@]}" || stop "apt-get cannot install ${missing[*]}: see its message above"
  fi
  mapfile -t missing < <(missing_packages)
  ((${#missing[@]} == 0)) || stop "still missing after apt-get: ${missing[*]}"
}

# build PRESET TARGET...: configure, then build these targets (all of them without names).
build() {
  local preset=$1
  shift
  say "Configuring and building ($preset)"
  (
    cd "$root"
    cmake --preset "$preset" --log-level=WARNING >/dev/null
    cmake --build --preset "$preset" --parallel "$(nproc)" ${1:+--target "$@"}
  )
}
