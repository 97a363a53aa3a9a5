// Colour maps whose order everyone sees, whatever colours they tell apart; statuses in colours of Okabe and Ito.

const hex = (text) => text.match(/.{6}/g).map((c) => [0, 2, 4].map((i) => parseInt(c.slice(i, i + 2), 16) / 255));

export const maps = {
  viridis: hex(
    "440154470d6048186a482374472d7b4537814240863e49893b528b375b8d33638d2f6b8e2c728e297a8e26828e23898e21918c1f988b1fa08822a785" +
      "28ae8032b67a3fbc734ec36b5ec96270cf5784d44b98d83eaddc30c2df23d8e219ece51bfde725"),
  cividis: hex(
    "00224e00285b002e6a0533711a386f273e6e32436d3b496c434e6c4b546c535a6d5a5f6e61656f686a716f70737676767d7c788482798c8878938e78" +
      "9b9476a39a74aba072b4a76fbcae6cc4b468cdbb63d5c25edec958e7d150f0d846f9e03afee838"),
  "blue-red, about 0": hex(
    "0530610e41791752901f63a82a71b23480b93f8ec0529dc86bacd184bcd99bc9e0aed3e6c2ddecd4e6f1e0ecf3ecf2f5f7f6f6f9eee7fbe5d8fddcc9" +
      "fbccb4f8bb9ef5aa89ee9677e48066db6b55d05548c53e3dba2832ab162a930e267c072267001f"),
};
export const diverging = "blue-red, about 0";

/** CONT of a patch: what it means, and its colour. */
export const statuses = [
  {value: -1, name: "without master", colour: [0.62, 0.62, 0.62]},
  {value: 0, name: "open", colour: [0.34, 0.71, 0.91]},
  {value: 1, name: "in contact", colour: [0.84, 0.37, 0.0]},
];

export const css = ([r, g, b]) => `rgb(${Math.round(255 * r)} ${Math.round(255 * g)} ${Math.round(255 * b)})`;

/** The colour of a map at a place from 0 to 1. */
export function at(map, place) {
  const list = maps[map];
  const x = Math.min(Math.max(place, 0), 1) * (list.length - 1);
  const first = Math.min(Math.floor(x), list.length - 2);
  return list[first].map((c, k) => c + (list[first + 1][k] - c) * (x - first));
}

/** Series of a chart, told apart by everyone, in light and in dark. */
export const series = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00"];
