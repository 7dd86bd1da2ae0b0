// The wipe: two of the page's own pictures over one another. The page is whole without it.
(function () {
  "use strict";
  var pictures = document.querySelectorAll("img[data-wipe]");
  var wipe = document.getElementById("wipe");
  if (!wipe || pictures.length < 2) {
    return;
  }
  var stage = wipe.querySelector(".stage");
  var at = document.getElementById("wipe-at");
  var sides = [
    { name: "wipe-left", image: document.getElementById("wipe-above") },
    { name: "wipe-right", image: document.getElementById("wipe-below") }
  ];
  sides.forEach(function (side, index) {
    var choice = document.getElementById(side.name);
    pictures.forEach(function (picture, number) {
      choice.add(new Option(picture.dataset.wipe, number, false, number === index));
    });
    function show() {
      var picture = pictures[choice.value];
      side.image.src = picture.src;
      side.image.alt = picture.alt;
      document.getElementById(side.name + "-figures").textContent = picture.dataset.figures;
    }
    choice.addEventListener("change", show);
    show();
  });
  function place(percent) {
    stage.style.setProperty("--at", Math.min(100, Math.max(0, percent)) + "%");
  }
  at.addEventListener("input", function () { place(at.value); });
  stage.addEventListener("pointermove", function (event) {
    if (event.buttons) {
      var box = stage.getBoundingClientRect();
      at.value = 100 * (event.clientX - box.left) / box.width;
      place(at.value);
    }
  });
  wipe.hidden = false;
})();
