# What the scripts share. Source it; it sets $root, the project's folder, and defines functions.
# shellcheck shell=bash
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# say TEXT: one line that tells what is being done, on standard error, so that standard output
# stays the script's result.
say() { printf '== %s\n' "$*" >&2; }

# give_up TEXT [STATUS]: one line that tells what is wrong and what to do.
give_up() {
  printf '%s: %s\n' "$(basename "$0")" "$1" >&2
  exit "${2:-1}"
}

# as_root COMMAND...: as root or through sudo. Fails where neither can be had without asking
# somebody who is not there.
as_root() {
  if [ "$(id -u)" = 0 ]; then
    "$@"
  elif command -v sudo > /dev/null && { [ -t 0 ] || sudo -n true 2> /dev/null; }; then
    sudo "$@"
  else
    return 1
  fi
}

# build_jobs: how many compilers may run at once: one a core, and 1.5 GB of free memory each.
build_jobs() {
  local cores memory limit jobs
  cores=$(nproc)
  memory=$(awk '/^MemAvailable/ { print int($2 / 1024) }' /proc/meminfo)
  limit=$(cat /sys/fs/cgroup/memory.max 2> /dev/null || echo max)
  if [[ $limit =~ ^[0-9]+$ ]] && ((limit / 1048576 < memory)); then
    memory=$((limit / 1048576))
  fi
  jobs=$((memory / 1536 < cores ? memory / 1536 : cores))
  echo $((jobs > 0 ? jobs : 1))
}

# fewer_lines: of ninja's [12/340] lines lets every 25th through, and everything else as it is.
fewer_lines() {
  local line
  while IFS= read -r line; do
    if [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]]; then
      ((BASH_REMATCH[1] % 25 == 0 || BASH_REMATCH[1] == BASH_REMATCH[2])) || continue
    fi
    printf '%s\n' "$line"
  done
}

# build_tree FOLDER TARGET [CMAKE OPTION...]: configures FOLDER (Release, Ninja) and builds the target.
# What CMake says is kept in FOLDER/configure.log and shown when it fails.
build_tree() {
  local folder=$1 target=$2 jobs
  shift 2
  mkdir -p "$folder"
  say "configuring ${folder#"$root"/}"
  if ! cmake -S "$root" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release "$@" \
    > "$folder/configure.log" 2>&1; then
    cat "$folder/configure.log" >&2
    give_up "CMake could not configure ${folder#"$root"/}: its reasons stand above"
  fi
  jobs=$(build_jobs)
  say "building ${folder#"$root"/} with $jobs jobs"
  if [ -t 2 ]; then
    ninja -C "$folder" -j "$jobs" "$target" >&2
  else
    ninja -C "$folder" -j "$jobs" "$target" 2>&1 | fewer_lines >&2
  fi || give_up "the build in ${folder#"$root"/} failed: the compiler's messages stand above"
}
