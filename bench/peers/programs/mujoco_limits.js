// What programs that run MuJoCo share.

const arena = "300M";  // of its own accord it takes more for a large sheet than WebAssembly has

/** MuJoCo goes back to its start, and only counts that, where something is not finite or too large. */
function requireNoReset(data) {
  for (let k = 0; k < data.warning.size(); ++k)
    if (data.warning.get(k).number > 0)
      throw Error(`MuJoCo has warned and gone back to its start before ${data.time} s`);
}

module.exports = {
  arena,
  requireNoReset
};
