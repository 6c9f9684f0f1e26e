// Saves what plotly draws, as SVG or PNG: the server asks by #sb-export, which names the view and the format and carries
// the figure. A plot that is in front is saved as it is seen, with its zoom; another one as the server made it.
(() => {
  let done = 0;

  async function save(wanted) {
    const plots = [...document.querySelectorAll(".js-plotly-plot")];
    const plot = plots.find((each) => each._fullLayout?.meta?.view === wanted.view && each.offsetParent !== null);
    if (plot === undefined && window.Plotly === undefined) {
      window.schuler.command("unsaved", wanted.view); // viser brings plotly with the first plot that needs it
      return;
    }
    const box = plot?.getBoundingClientRect() ?? { width: wanted.width, height: wanted.width * wanted.aspect };
    const picture = await Plotly.toImage(plot ?? JSON.parse(wanted.figure), {
      format: wanted.format,
      width: Math.round(box.width),
      height: Math.round(box.height),
      scale: wanted.format === "png" ? 2 : 1,
    });
    const link = document.createElement("a");
    link.href = picture;
    link.download = `${wanted.name}.${wanted.format}`;
    document.body.append(link);
    link.click();
    link.remove();
  }

  setInterval(() => {
    const wanted = document.getElementById("sb-export")?.dataset;
    if (wanted === undefined || Number(wanted.count) === done) return;
    done = Number(wanted.count);
    save(wanted).catch((error) => console.warn(`not saved: ${error}`));
  }, 200);
})();
