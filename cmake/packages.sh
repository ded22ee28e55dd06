#!/bin/sh
# packages.sh PACKAGE…: installs the Debian packages that are missing, naming them; silent when all are there.
# Works as root or through sudo.
set -eu

missing=
for package in "$@"; do
    case $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true) in
    installed*) ;;
    *) missing="$missing $package" ;;
    esac
done
[ -n "$missing" ] || exit 0

if ! command -v apt-get >/dev/null; then
    echo "tetcast: this is no Debian system, so these packages (by their Debian names) are left to you:$missing" >&2
    exit 0
fi
as_root=
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
        echo "tetcast: missing packages:$missing" >&2
        echo "tetcast: without root and without sudo they cannot be installed; run as root: apt-get install$missing" >&2
        exit 1
    fi
    as_root="sudo"
fi

apt() {
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=600 -o Acquire::Retries=3 "$@"
}

echo "tetcast: installing missing Debian packages:$missing" >&2
set -- $missing
ls /var/lib/apt/lists/*_Packages* >/dev/null 2>&1 || apt update >&2
# Lists that are too old name files that are gone: then get new ones and try again.
apt install -y --no-install-recommends "$@" >&2 || {
    apt update >&2
    apt install -y --no-install-recommends "$@" >&2
}
