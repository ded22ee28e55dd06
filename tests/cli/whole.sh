#!/bin/sh
# Output files appear whole or not at all, and nothing is left beside them.
. "$TC_SOURCE/tests/cli/lib.sh"
ball="synth:ball:500 --size 8x8 --driver reference"
mkdir room

run 1 render $ball -o missing/a.png
says "missing"
mkdir folder.png
run 1 render $ball -o folder.png
says "folder.png is a folder"
[ -z "$(ls -A folder.png)" ] || fail "something was written into the folder"
run 2 render $ball -o room/
run 1 render $ball -o room/a.png --stats missing/s.json
absent room/a.png
run 1 synth ball --cells 500 -o missing/ball.vtu
says "missing"

# A failure leaves the old file as it was.
echo old >room/a.png
run 1 render no-such-file.vtu -o room/a.png
[ "$(cat room/a.png)" = old ] || fail "a failed render touched the old file"
run 0 render $ball -o room/a.png --stats room/s.json
there room/s.json
[ "$(head -c 4 room/a.png | tail -c 3)" = PNG ] || fail "the old file was not replaced"
[ "$(ls -A room | sort | tr '\n' ' ')" = "a.png s.json " ] || fail "files were left beside: $(ls -A room)"

# Files get the mode that the user's mask gives.
umask 027
run 0 render $ball -o room/m.png --stats room/m.json
[ "$(ls -l room/m.png room/m.json | cut -c1-10 | sort -u)" = "-rw-r-----" ] || fail "modes: $(ls -l room)"
umask 022

# A link keeps pointing to its file; a device is written to, not replaced.
echo old >room/target.json
ln -s target.json room/link.json
run 0 render $ball -o room/a.png --stats room/link.json
[ -h room/link.json ] || fail "the link was replaced"
json room/target.json has tetcast
run 0 render $ball -o room/a.png --stats /dev/null
[ -c /dev/null ] || fail "/dev/null was replaced"
if [ -w /dev/full ]; then
    run 1 render $ball -o room/a.png --stats /dev/full
    says "/dev/full could not be written"
    [ -c /dev/full ] || fail "/dev/full was replaced"
fi

# A folder that cannot be written to is found before any work; root may write everywhere.
if [ "$(id -u)" -ne 0 ]; then
    chmod a-w room
    run 1 render no-such-file.vtu -o room/b.png
    says "room/b.png cannot be written"
    chmod u+w room
fi
finish
