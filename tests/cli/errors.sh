#!/bin/sh
# --verify and --error-image: what is said of the pixels, looked at or not, and the image of their errors.
. "$TC_SOURCE/tests/cli/lib.sh"
ball="synth:ball:500 --size 32x24 -o a.png"

# Without --verify every pixel is looked at, and nothing is left to be said of others.
run 0 render $ball --error-image e.png --stats s.json
says "verify: all 768 pixels"
says "wrote the errors to e.png"
says_not "confidence"
json s.json eq verify.pixels 768 eq verify.pixels_all 768 eq verify.unseen_share 0 eq verify.confidence 0.95 \
    le verify.max_abs_error 0.00196
there e.png
grep -aq "tetcast:error_image" e.png || fail "the error image does not say what it shows"
grep -aq "white 1e-1 and more, turquoise ill-posed, grey not looked at" e.png || fail "the legend is missing"
grep -aq '"unseen_share":0' a.png || fail "the picture does not carry the confidence bound"

# A sample says what it can of the rest, in the words, the numbers and the picture.
run 0 render $ball --error-image e.exr --verify 300 --stats s.json
says "verify: 300 pixels"
says "with 95 % confidence at most 1.3 % of the other pixels err by more than"
json s.json eq verify.pixels 300 eq verify.pixels_all 768 ge verify.unseen_share 0.0128 le verify.unseen_share 0.0129
grep -aq '"unseen_share":0.0128' a.png || fail "the picture does not carry the confidence bound"
there e.exr
run 0 render $ball --verify 300
says "with 95 % confidence"

# As floats the errors are those that were measured; more pixels looked at differ from fewer in alpha alone.
run 0 render $ball --error-image all.exr
run 2 compare e.exr all.exr
run 0 render $ball --error-image e.tif --verify 300
run 0 compare e.exr e.tif

# With several rays a pixel the mean of as many is the truth.
for samples in 4 16; do
    run 0 render $ball --samples $samples --verify 768 --stats s.json
    json s.json le verify.max_abs_error 0.00196
done

# Whole or not at all; nothing is left behind when it cannot be written.
rm -f a.png
run 1 render $ball --error-image missing/e.png
says "missing"
absent a.png
mkdir folder.png
run 1 render $ball --error-image folder.png
says "folder.png is a folder"
run 0 render $ball --error-image -
[ "$(head -c 4 out | tail -c 3)" = PNG ] || fail "stdout is no PNG"
finish
