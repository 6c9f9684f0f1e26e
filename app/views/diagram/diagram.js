// A block of the diagram is pressed by keyboard as a button is: SVG has none of its own.
addEventListener(
  "keydown",
  (event) => {
    const block = event.target instanceof SVGGElement && event.target.closest(".sb-d [data-command]");
    if (!block || (event.key !== "Enter" && event.key !== " ")) return;
    event.preventDefault();
    event.stopPropagation();
    block.dispatchEvent(new MouseEvent("click", { bubbles: true }));
  },
  true,
);
