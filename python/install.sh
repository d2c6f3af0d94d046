#!/bin/sh
# Builds the Python package and installs it into an environment of its own: ./run.sh python [FOLDER]
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
place=${1:-${CARGO_TARGET_DIR:-$root/target}/python}
python=${PYTHON:-python3}

missing() { echo "error: $1; $2" >&2; exit 2; }
command -v "$python" >/dev/null || missing "there is no $python" "install Python 3.10 or newer (Debian: apt-get install python3 python3-venv), or name it: PYTHON=/path/to/python ./run.sh python"
"$python" -c 'import sys; sys.exit(sys.version_info < (3, 10))' || missing "$python is older than 3.10" "name a newer one: PYTHON=/path/to/python ./run.sh python"
if [ ! -x "$place/bin/python" ]; then
    echo "making the environment $place ..." >&2
    "$python" -m venv "$place" || missing "$python cannot make an environment" "on Debian: apt-get install python3-venv"
fi
echo "building the package, some minutes for the first time ..." >&2
"$place/bin/python" -m pip install --quiet --disable-pip-version-check --no-warn-script-location "$root/python[env,plot]"
cat <<TEXT
installed       $("$place/bin/python" -c 'import vodca; print("vodca", vodca.__version__)') in $place
to use it       $place/bin/python, or: . $place/bin/activate
to try it       $place/bin/python -c "import vodca; print(vodca.run('ex14_d').summary)"
elsewhere       pip install $root/python
TEXT
