#!/bin/sh
# Runs both commands of the README as a machine does that has never seen them: a fresh clone of the last commit in an
# empty folder, an empty home, no caches, no settings of ours, and one font.
#
#   tools/bare.sh [run|test] [--slow] [--font FAMILY] [--keep]
#
# run, test   only `make run`, or only `make test`; by default one after the other
# --slow      `make test SLOW=yes`, as continuous integration does
# --font      the one font: "DejaVu Sans" (wide, the default) or "Liberation Sans"
# --keep      leave the folder where it is
set -u

root=$(cd "$(dirname "$0")/.." && pwd -P)
commands='run test' font='DejaVu Sans' keep=no slow=
while [ $# -gt 0 ]; do
  case $1 in
    run | test) commands=$1 ;;
    --slow) slow=yes ;;
    --font) font=${2:?--font needs a family}; shift ;;
    --keep) keep=yes ;;
    *) sed -n '2,10s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
  esac
  shift
done

# The Python itself: what stands for it on the PATH may need the home.
python=$(python3 -c 'import os, sys; print(os.path.realpath(sys.executable))') || exit 1
bare=$(mktemp -d "${TMPDIR:-/tmp}/bare.XXXXXX") || exit 1
served=
leave() {
  [ -z "$served" ] || kill "$served" 2>/dev/null
  if [ "$keep" = yes ]; then echo "kept: $bare"; else rm -rf "$bare"; fi
}
trap leave EXIT
trap 'exit 130' INT TERM

git clone --quiet "$root" "$bare/clone" || exit 1
mkdir "$bare/home" "$bare/tmp" "$bare/bin" "$bare/font"
# Where packages come from is the machine's: of the old home that alone stays.
for config in "${PIP_CONFIG_FILE:-}" "${XDG_CONFIG_HOME:-$HOME/.config}/pip/pip.conf" "$HOME/.pip/pip.conf"; do
  if [ -f "$config" ]; then export PIP_CONFIG_FILE="$config"; break; fi
done
for name in $(env | sed -n 's/^\([A-Za-z_][A-Za-z0-9_]*\)=.*/\1/p'); do
  case $name in
    SCHULER_* | XDG_* | PLAYWRIGHT_* | PYTHON* | NUMBA_* | MPL* | VIRTUAL_ENV | MAKE* | MFLAGS | PYTEST_*) unset "$name" ;;
  esac
done
export HOME="$bare/home" TMPDIR="$bare/tmp" PIP_NO_CACHE_DIR=1 PATH="$(dirname "$python"):$PATH"
FONTCONFIG_FILE=$(cd "$root" && "$python" -B -c '
import sys
from pathlib import Path
from tools.fonts import one_font
print(one_font(sys.argv[1], Path(sys.argv[2])).get("FONTCONFIG_FILE", ""))' "$font" "$bare/font") || exit 1
if [ -z "$FONTCONFIG_FILE" ]; then echo "no $font here" >&2; exit 1; fi
export FONTCONFIG_FILE
cd "$bare/clone" || exit 1
echo "== bare machine: $(git log -1 --format='%h %s'), $("$python" --version), $font only"

seconds() { echo $(($(date +%s) - $1)); }

# Prints what an address answers; fails unless that is a success.
answer() { "$python" -c 'import sys, urllib.request as r; print(r.urlopen(sys.argv[1], timeout=5).read().decode())' "$1"; }

# Whether the page, opened in a browser, shows its first run within a minute. With what `make run` has installed.
shows_a_run() {
  .venv/bin/python - "$1" "$2" "$bare/browser" <<'PYTHON'
import json, subprocess, sys, time
from pathlib import Path
from urllib.request import urlopen
from websockets.sync.client import connect

browser, address, folder = sys.argv[1:]
flags = ["--headless", "--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader", "--no-first-run"]
flags += ["--remote-debugging-port=0", f"--user-data-dir={folder}"]
process = subprocess.Popen([browser, *flags, address], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
ask = {"id": 1, "method": "Runtime.evaluate"}
ask["params"] = {"expression": "document.querySelector('#sb-run[data-run]') !== null"}
port, shown, last = Path(folder) / "DevToolsActivePort", False, time.monotonic() + 60.0
while not shown and time.monotonic() < last:
    time.sleep(1.0)
    try:
        pages = json.load(urlopen(f"http://127.0.0.1:{port.read_text().split()[0]}/json/list"))
        page = next(page for page in pages if page["url"].startswith(address))
        with connect(page["webSocketDebuggerUrl"], max_size=None) as tools:
            tools.send(json.dumps(ask))
            shown = json.loads(tools.recv())["result"]["result"]["value"]
    except (OSError, IndexError, StopIteration):  # not yet open
        continue
process.terminate()
process.wait()
sys.exit(not shown)
PYTHON
}

# `make run` opens the page by itself: here in what BROWSER names, which notes the address that it is given.
make_run() {
  begun=$(date +%s) log=$bare/run.log
  printf '#!/bin/sh\necho "$1" > "%s/opened"\n' "$bare" > "$bare/bin/browser"
  chmod +x "$bare/bin/browser"
  port=$("$python" -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
  BROWSER="$bare/bin/browser %s" make --no-print-directory run PORT="$port" > "$log" 2>&1 < /dev/null &
  served=$!
  until [ -f "$bare/opened" ] && address=$(cat "$bare/opened") && answer "${address%/}/healthz" > "$bare/health" 2>/dev/null; do
    if ! kill -0 "$served" 2>/dev/null || [ "$(seconds "$begun")" -gt 1800 ]; then
      served=; cat "$log"; echo "== make run: did not serve, $(seconds "$begun") s"; return 1
    fi
    sleep 1
  done
  sed 's/^/   /' "$log"
  told="served after $(seconds "$begun") s"
  failed=0
  if answer "$address" | grep -qi '<html'; then told="$told, the page answers"
  else failed=1 told="$told, THE PAGE DOES NOT ANSWER"; fi
  browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || browser=
  if [ -z "$browser" ]; then told="$told, no browser here to open it in"
  elif shows_a_run "$browser" "$address"; then told="$told, opened in a browser it shows its first run"
  else failed=1 told="$told, OPENED IN A BROWSER IT SHOWS NO RUN"; fi
  kill "$served"; wait "$served" 2>/dev/null; served=
  echo "== make run: $told; ended after $(seconds "$begun") s"
  return $failed
}

make_test() {
  begun=$(date +%s)
  make --no-print-directory test SLOW="$slow" < /dev/null
  code=$?
  echo "== make test${slow:+ SLOW=$slow}: exit code $code after $(seconds "$begun") s"
  return $code
}

result=0
for command in $commands; do "make_$command" || result=1; done
exit $result
